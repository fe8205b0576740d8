"""Is something wrong, since when, and what can it be?"""
