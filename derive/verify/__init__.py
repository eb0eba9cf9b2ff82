"""A library in, out proofs that its programs are right, and how wrong rounding makes them."""
