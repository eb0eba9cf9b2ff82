"""The program of a rate in, the programs of its steps in time out."""
