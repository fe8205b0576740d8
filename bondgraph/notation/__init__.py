"""Formulas for people and programs: one tree of what is written, one speller a notation."""
