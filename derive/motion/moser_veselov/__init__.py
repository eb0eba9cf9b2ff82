"""Steps of the discrete rigid body, exact in what is conserved."""
