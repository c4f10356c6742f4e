# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads VTU files whose numbers are appended, raw and compressed by zlib."""
import struct
import xml.etree.ElementTree as xml
import zlib

LETTERS = {"Float32": "f", "Int32": "i", "UInt8": "B"}


class Piece:
    def __init__(self, path):
        with open(path, "rb") as file:
            text, data = file.read().split(b'<AppendedData encoding="raw">\n_')
        assert data.endswith(b"\n</AppendedData>\n</VTKFile>\n")
        self.data = data
        root = xml.fromstring(text.decode() + "</VTKFile>")
        assert root.get("header_type") == "UInt64"
        piece = root.find(".//Piece")
        self.n_points = int(piece.get("NumberOfPoints"))
        self.n_cells = int(piece.get("NumberOfCells"))
        self.points = self.numbers(piece.find("Points/DataArray"))
        self.cells, self.at_points, self.in_cells = (
            {array.get("Name"): self.numbers(array)
             for array in piece.find(kind).iter("DataArray")}
            for kind in ("Cells", "PointData", "CellData"))
        n = self.cells["offsets"][0]
        assert self.cells["offsets"] == tuple(
            n * (cell + 1) for cell in range(self.n_cells))
        assert len(self.points) == 3 * self.n_points
        assert len(self.cells["connectivity"]) == n * self.n_cells
        assert set(self.cells["connectivity"]) == set(range(self.n_points))
        for name, field in self.at_points.items():
            assert len(field) in (self.n_points, 3 * self.n_points), name
        for name, field in self.in_cells.items():
            assert len(field) == self.n_cells, name

    def numbers(self, array):
        """Number of blocks, size of all but the last one, and of that if it is
        smaller, sizes when compressed; the blocks."""
        at = int(array.get("offset"))
        n_blocks, size, last = struct.unpack_from("<3Q", self.data, at)
        compressed = struct.unpack_from("<%dQ" % n_blocks, self.data, at + 24)
        at += 24 + 8 * n_blocks
        numbers = b""
        for block, length in enumerate(compressed):
            numbers += zlib.decompress(self.data[at:at + length])
            at += length
            assert len(numbers) == (block + 1) * size or (
                block == n_blocks - 1 and
                len(numbers) == block * size + last)
        letter = LETTERS[array.get("type")]
        return struct.unpack(
            "<%d%s" % (len(numbers) // struct.calcsize(letter), letter),
            numbers)
