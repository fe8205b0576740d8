"""The nouns: one file per stage of knowledge about a model."""
