"""What the structure alone can tell: testable subsets, isolability, placement of sensors."""
