# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads VTU files as deal.II writes them: each cell has points of its own, numbers are
compressed by zlib in base64."""
import base64
import struct
import xml.etree.ElementTree as xml
import zlib

LETTERS = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt32": "I", "UInt8": "B",
           "Int64": "q", "UInt64": "Q"}


class Piece:
    def __init__(self, path):
        root = xml.parse(path).getroot()
        assert root.get("compressor") == "vtkZLibDataCompressor"
        self.n_points = self.n_cells = 0
        self.points, self.cells, self.at_points = (), {}, {}
        for piece in root.iter("Piece"):  # large bodies have several
            firsts = {"connectivity": self.n_points,
                      "offsets": len(self.cells.get("connectivity", ()))}
            self.n_points += int(piece.get("NumberOfPoints"))
            self.n_cells += int(piece.get("NumberOfCells"))
            self.points += self.numbers(piece.find("Points/DataArray"))
            for kind, lists in (("Cells", self.cells), ("PointData", self.at_points)):
                for array in piece.find(kind).iter("DataArray"):
                    name = array.get("Name")
                    first = firsts.get(name, 0)
                    lists[name] = lists.get(name, ()) + tuple(
                        first + number for number in self.numbers(array))
        n = self.cells["offsets"][0]
        assert self.cells["offsets"] == tuple(
            n * (cell + 1) for cell in range(self.n_cells))
        assert len(self.points) == 3 * self.n_points
        assert set(self.cells["connectivity"]) == set(range(self.n_points))
        # Fields that are constant in each cell, there.
        self.in_cells = {}
        for name, field in self.at_points.items():
            assert len(field) in (self.n_points, 3 * self.n_points), name
            if len(field) == self.n_points:
                of_cells = [{repr(field[i]) for i in
                             self.cells["connectivity"][n * cell:n * (cell + 1)]}
                            for cell in range(self.n_cells)]
                if all(len(values) == 1 for values in of_cells):
                    self.in_cells[name] = tuple(
                        field[self.cells["connectivity"][n * cell]]
                        for cell in range(self.n_cells))

    def numbers(self, array):
        """Of the header the number of blocks, their size, that of the last one, and the
        compressed one of each."""
        text = "".join(array.text.split())
        (n_blocks,) = struct.unpack("<I", base64.b64decode(text[:8])[:4])
        length = 4 * ((4 * (3 + n_blocks) + 2) // 3)
        header = struct.unpack("<%dI" % (3 + n_blocks), base64.b64decode(text[:length]))
        data, numbers, at = base64.b64decode(text[length:]), b"", 0
        for size in header[3:]:
            numbers += zlib.decompress(data[at:at + size])
            at += size
        letter = LETTERS[array.get("type")]
        return struct.unpack(
            "<%d%s" % (len(numbers) // struct.calcsize(letter), letter), numbers)
