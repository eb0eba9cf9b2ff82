"""The speed-against-error report: motions by our steppers and by peers, and the page about them."""
