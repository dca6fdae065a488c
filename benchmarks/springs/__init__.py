"""How fast the spring-muscle face builds, poses and runs live."""
