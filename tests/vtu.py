# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads VTU files as output/vtu_grid writes them: numbers stand behind the description,
in blocks compressed by zlib."""
import struct
import xml.etree.ElementTree as xml
import zlib

LETTERS = {"Float32": "f", "Int32": "i", "UInt8": "B"}


class Piece:
    def __init__(self, path):
        with open(path, "rb") as file:
            description, begin, self.data = file.read().partition(
                b'<AppendedData encoding="raw">\n_')
        root = xml.fromstring(description + b"</VTKFile>")
        assert begin and root.attrib == {
            "type": "UnstructuredGrid", "version": "1.0", "byte_order": "LittleEndian",
            "header_type": "UInt32", "compressor": "vtkZLibDataCompressor"}, root.attrib
        (piece,) = root.iter("Piece")
        self.n_points = int(piece.get("NumberOfPoints"))
        self.n_cells = int(piece.get("NumberOfCells"))
        self.end = 0
        (self.points,) = self.arrays(piece, "Points").values()
        self.cells, self.at_points, self.in_cells = (
            self.arrays(piece, kind) for kind in ("Cells", "PointData", "CellData"))
        assert self.data[self.end:] == b"\n</AppendedData>\n</VTKFile>\n"
        n = self.cells["offsets"][0]
        assert self.cells["offsets"] == tuple(
            n * (cell + 1) for cell in range(self.n_cells))
        assert len(self.cells["types"]) == self.n_cells
        assert len(self.points) == 3 * self.n_points
        assert set(self.cells["connectivity"]) == set(range(self.n_points))
        for fields, size in ((self.at_points, self.n_points),
                             (self.in_cells, self.n_cells)):
            assert {len(field) for field in fields.values()} <= {size, 3 * size}

    def arrays(self, piece, kind):
        return {array.get("Name"): self.numbers(array)
                for array in piece.find(kind).iter("DataArray")}

    def numbers(self, array):
        """Arrays follow each other. Of the header the number of blocks, their size, that of
        the last one if it is smaller, and the compressed one of each."""
        assert array.get("format") == "appended" and int(array.get("offset")) == self.end
        n_blocks, size, rest = struct.unpack_from("<3I", self.data, self.end)
        left = struct.unpack_from(f"<{n_blocks}I", self.data, self.end + 12)
        self.end += 12 + 4 * n_blocks
        numbers = b""
        for k, n_bytes in enumerate(left):
            block = zlib.decompress(self.data[self.end:self.end + n_bytes])
            assert len(block) == (rest if rest and k == n_blocks - 1 else size)
            numbers += block
            self.end += n_bytes
        letter = LETTERS[array.get("type")]
        return struct.unpack(f"<{len(numbers) // struct.calcsize(letter)}{letter}", numbers)
