"""The parts of elaboration: instances, connections, expressions and units, one file each."""
