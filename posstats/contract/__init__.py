"""What posstats writes down and reads back: one frozen dataclass a JSON file, without NumPy.

``results``, ``adjustment``, ``acceptance``, ``comparison`` and ``wucaps`` hold the dataclasses;
``files`` writes and reads all of them.
"""
