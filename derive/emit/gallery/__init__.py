"""The gallery: a card a scene, with a drawing made from the scene itself."""
