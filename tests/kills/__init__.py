"""The monitor killed with `kill -9` at random moments, on every source: no verdict is lost."""
