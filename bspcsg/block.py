"""The public module of blocks, which are documented in `bspcsg.operations.block`."""

from .operations.block import Block, Unfilled

__all__ = ["Block", "Unfilled"]
