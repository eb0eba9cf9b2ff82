"""Steps made of turns about axes that are exact each."""
