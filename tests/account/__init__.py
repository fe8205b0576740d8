"""A long replay in which something happens every minute: the account at its end adds up exactly."""
