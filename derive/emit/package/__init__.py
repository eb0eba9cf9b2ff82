"""A scene's C as a folder for firmware: a library in, what build tools read and a test out."""
