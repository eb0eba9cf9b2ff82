"""The gallery: a card a scene, with a drawing made from the scene itself."""

from derive.gallery.card import card, gallery

__all__ = ["card", "gallery"]
