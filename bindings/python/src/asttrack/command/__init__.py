"""The command `python -m asttrack`: a module for each sub-command, with `add` for its arguments and `run` for its work.

They import what is optional (OpenCV, matplotlib, dask) inside `run` only, so that help and errors need none of it.
"""
