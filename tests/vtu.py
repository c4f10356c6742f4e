# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads VTU files as output/vtu_grid writes them: numbers in base64, in blocks
compressed by zlib."""
import base64
import struct
import xml.etree.ElementTree as xml
import zlib

LETTERS = {"Float32": "f", "Int32": "i", "UInt8": "B"}


class Piece:
    def __init__(self, path):
        root = xml.parse(path).getroot()
        assert root.attrib == {
            "type": "UnstructuredGrid", "version": "1.0", "byte_order": "LittleEndian",
            "header_type": "UInt32", "compressor": "vtkZLibDataCompressor"}, root.attrib
        (piece,) = root.iter("Piece")
        self.n_points = int(piece.get("NumberOfPoints"))
        self.n_cells = int(piece.get("NumberOfCells"))
        (self.points,) = self.arrays(piece, "Points").values()
        self.cells, self.at_points, self.in_cells = (
            self.arrays(piece, kind) for kind in ("Cells", "PointData", "CellData"))
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
        """Of the header the number of blocks, their size, that of the last one if it is smaller,
        and the compressed one of each."""
        assert array.get("format") == "binary"
        text = array.text.strip()
        (n_blocks,) = struct.unpack("<I", base64.b64decode(text[:8])[:4])
        length = (12 + 4 * n_blocks + 2) // 3 * 4
        _, size, rest, *left = struct.unpack(
            f"<{3 + n_blocks}I", base64.b64decode(text[:length], validate=True))
        data, numbers = base64.b64decode(text[length:], validate=True), b""
        for k, n_bytes in enumerate(left):
            block = zlib.decompress(data[:n_bytes])
            assert len(block) == (rest if rest and k == n_blocks - 1 else size)
            numbers += block
            data = data[n_bytes:]
        assert not data
        letter = LETTERS[array.get("type")]
        return struct.unpack(f"<{len(numbers) // struct.calcsize(letter)}{letter}", numbers)
