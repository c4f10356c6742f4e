// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/output/vtu_grid.h>

#include <boost/endian/conversion.hpp>

#include <zlib.h>

#include <algorithm>
#include <new>

namespace Debond
{
  namespace
  {
    using Bytes = std::vector<unsigned char>;



    /// Appends a block in its compressed form, and returns how many bytes that
    /// has.
    std::size_t
    deflate_block(const Bytef *const block,
                  const std::size_t  n_bytes,
                  const int          strategy,
                  Bytes             &data)
    {
      // The data get room for the worst case first, which compressBound() knows
      // for the sizes of window and memory below, zlib's defaults. So one call
      // of deflate() takes the whole block. With these 15 bits the block has
      // the header of zlib, which readers of VTK expect. deflateEnd() does
      // nothing for a stream that has not begun.
      const std::size_t begin = data.size();
      data.resize(begin + compressBound(n_bytes));
      z_stream   stream = {};
      const bool has_begun =
        deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 15, 8, strategy) ==
        Z_OK;
      stream.next_in   = const_cast<Bytef *>(block);
      stream.avail_in  = static_cast<uInt>(n_bytes);
      stream.next_out  = &data[begin];
      stream.avail_out = static_cast<uInt>(data.size() - begin);
      const bool is_done =
        has_begun && deflate(&stream, Z_FINISH) == Z_STREAM_END;
      deflateEnd(&stream);
      if (!is_done) // for want of memory
        throw std::bad_alloc();
      data.resize(begin + stream.total_out);
      return stream.total_out;
    }



    /// Writes the number of blocks, their size, that of the last one if it is
    /// smaller, and the compressed size of each, then the blocks, both in
    /// base64, which all readers know.
    void
    compress(const Bytef *const numbers,
             const std::size_t  n_bytes,
             std::ostream      &out)
    {
      // Blocks of a megabyte can be read one by one, without room for the whole
      // array. The size of the last block is 0 if all blocks are full, and an
      // array without numbers has a header with 0 blocks. The header is known
      // only after the last block, so that the data wait in memory until then.
      constexpr std::size_t size_of_block = 1 << 20, size_of_sample = 1 << 15;
      const std::size_t     n_blocks =
        (n_bytes + size_of_block - 1) / size_of_block;
      std::vector<std::uint32_t> header = {static_cast<std::uint32_t>(n_blocks),
                                           size_of_block,
                                           static_cast<std::uint32_t>(
                                             n_bytes % size_of_block)};
      Bytes                      data;
      for (std::size_t done = 0; done < n_bytes; done += size_of_block)
        {
          // Where hardly a number comes again, which the beginning of the block
          // says, looking for repetitions takes three times longer for nothing.
          const std::size_t size   = std::min(size_of_block, n_bytes - done),
                            sample = std::min(size_of_sample, size),
                            first  = data.size();
          const bool has_repetitions =
            deflate_block(numbers + done, sample, Z_DEFAULT_STRATEGY, data) <
            sample / 4 * 3;
          data.resize(first);
          header.push_back(static_cast<std::uint32_t>(
            deflate_block(numbers + done,
                          size,
                          has_repetitions ? Z_DEFAULT_STRATEGY : Z_RLE,
                          data)));
        }
      // Header and data are encoded apart: a reader decodes the header first,
      // which says how many bytes follow.
      const auto *const bytes = reinterpret_cast<const Bytef *>(header.data());
      out << dealii::Utilities::encode_base64(
               {bytes, bytes + header.size() * sizeof(header[0])})
          << dealii::Utilities::encode_base64(data);
    }



    void
    begin_file(const std::string &type, std::ostream &out)
    {
      // Numbers are written as they are in memory, and the file says which of
      // the two orders of bytes that is. Headers of arrays have 32 bits, which
      // suffices for blocks of this size.
      out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type
          << "\" version=\"1.0\" byte_order=\""
          << (boost::endian::order::native == boost::endian::order::little ?
                "LittleEndian" :
                "BigEndian")
          << "\" header_type=\"UInt32\" "
             "compressor=\"vtkZLibDataCompressor\">\n<"
          << type;
    }



    /// Scalars are said to have no number of components: with one some readers
    /// make columns of them.
    std::string
    attributes(const std::string &type, const VtuGrid::Field &field)
    {
      return "type=\"" + type + "\" Name=\"" + field.name + '"' +
             (field.n_components == 1 ?
                "" :
                " NumberOfComponents=\"" + std::to_string(field.n_components) +
                  '"');
    }



    template <typename Number>
    void
    add_array(const std::string         &described,
              const std::vector<Number> &numbers,
              std::ostream              &out)
    {
      // In a file without an appended part "binary" stands for numbers in
      // base64 between the tags.
      out << "<DataArray " << described << " format=\"binary\">\n";
      compress(reinterpret_cast<const Bytef *>(numbers.data()),
               numbers.size() * sizeof(Number),
               out);
      out << "\n</DataArray>\n";
    }



    void
    add_fields(const std::string                 &where,
               const std::vector<VtuGrid::Field> &fields,
               std::ostream                      &out)
    {
      // All fields are in single precision, which is half as many bytes;
      // pictures show no more digits.
      out << '<' << where << ">\n";
      for (const VtuGrid::Field &field : fields)
        add_array(attributes("Float32", field), field.numbers, out);
      out << "</" << where << ">\n";
    }
  } // namespace



  void
  write_vtu(const VtuGrid &grid, std::ostream &out)
  {
    // A file has one piece with points, cells, numbers at points and numbers in
    // cells, in this order. Cells are three arrays: the points of all cells one
    // behind the other, the place behind the last point of each cell there, and
    // the kind of each cell. All cells are of one kind, so that the last two
    // follow from the number of cells.
    const std::size_t         n_cells = grid.cells.size() / grid.points_of_cell;
    std::vector<std::int32_t> ends(n_cells);
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      ends[cell] = static_cast<std::int32_t>((cell + 1) * grid.points_of_cell);

    begin_file("UnstructuredGrid", out);
    out << ">\n<Piece NumberOfPoints=\"" << grid.points.numbers.size() / 3
        << "\" NumberOfCells=\"" << n_cells << "\">\n<Points>\n";
    add_array(attributes("Float32", grid.points), grid.points.numbers, out);
    out << "</Points>\n<Cells>\n";
    add_array(attributes("Int32", {"connectivity"}), grid.cells, out);
    add_array(attributes("Int32", {"offsets"}), ends, out);
    add_array(attributes("UInt8", {"types"}),
              std::vector<std::uint8_t>(n_cells,
                                        static_cast<std::uint8_t>(grid.type)),
              out);
    out << "</Cells>\n";
    add_fields("PointData", grid.at_points, out);
    add_fields("CellData", grid.in_cells, out);
    out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  }



  void
  write_pvtu(const VtuGrid                  &grid,
             const std::vector<std::string> &pieces,
             std::ostream                   &out)
  {
    // The file has no numbers: it lists the fields that each piece has and the
    // files of the pieces, relative to its own folder. Points have coordinates
    // in single precision, as in the pieces. No piece has cells of another one.
    const auto declare = [&out](const std::string                 &where,
                                const std::vector<VtuGrid::Field> &fields) {
      out << "<P" << where << ">\n";
      for (const VtuGrid::Field &field : fields)
        out << "<PDataArray " << attributes("Float32", field) << "/>\n";
      out << "</P" << where << ">\n";
    };
    begin_file("PUnstructuredGrid", out);
    out << " GhostLevel=\"0\">\n";
    declare("Points", {{"Points", 3}});
    declare("PointData", grid.at_points);
    declare("CellData", grid.in_cells);
    for (const std::string &piece : pieces)
      out << "<Piece Source=\"" << piece << "\"/>\n";
    out << "</PUnstructuredGrid>\n</VTKFile>\n";
  }
} // namespace Debond
