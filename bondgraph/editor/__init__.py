"""Answers about a model while it is written; only `language_server` knows a protocol."""
