"""What residuals are worth: signatures, modes, detectability, isolability, verification."""
