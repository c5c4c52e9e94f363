"""Blocks, where users find them; see `bspcsg.operations.block`."""

from .operations.block import Block, Unfilled

__all__ = ["Block", "Unfilled"]
