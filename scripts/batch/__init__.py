"""Pieces of scripts/retarget-batch. Python 3.9 or later, standard library only."""
