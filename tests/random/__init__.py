"""Bond graphs that nobody drew: random structure, elements, sensors and unknown inputs."""
