"""The parts of a drawn bond graph: arrangement, places, scene, canvas."""
