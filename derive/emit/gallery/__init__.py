"""The gallery: a card a scene, with a drawing made from the scene itself."""

from derive.emit.gallery.card import card, gallery

__all__ = ["card", "gallery"]
