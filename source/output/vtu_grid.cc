// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>

#include <debond/output/vtu_grid.h>

#include <boost/endian/conversion.hpp>

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>

namespace Debond
{
  namespace
  {
    /// What stands behind the description.
    class AppendedData
    {
    public:
      /// Returns where in the data the numbers begin.
      template <typename Number>
      std::size_t
      add(const std::vector<Number> &numbers)
      {
        const std::size_t offset  = bytes.size();
        const std::size_t n_bytes = numbers.size() * sizeof(Number);
        const std::size_t n_blocks =
          (n_bytes + size_of_block - 1) / size_of_block;

        // The number of blocks, the sizes of all but the last and of the last
        // one if it is smaller, and what is left of each.
        std::vector<std::uint64_t> header = {n_blocks,
                                             size_of_block,
                                             n_bytes % size_of_block};
        header.resize(3 + n_blocks);
        const std::size_t size_of_header = header.size() * sizeof(header[0]);
        bytes.resize(offset + size_of_header);
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            const std::size_t begin = block * size_of_block;
            header[3 + block]       = add_block(
              reinterpret_cast<const unsigned char *>(numbers.data()) + begin,
              std::min(size_of_block, n_bytes - begin));
          }
        const auto *const first =
          reinterpret_cast<const unsigned char *>(header.data());
        std::copy(first, first + size_of_header, bytes.begin() + offset);
        return offset;
      }

      void
      write(std::ostream &out) const
      {
        out.write(reinterpret_cast<const char *>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
      }

    private:
      /// Returns its size when compressed.
      std::size_t
      add_block(const unsigned char *const block, const std::size_t n_bytes)
      {
        const std::size_t begin        = bytes.size();
        uLongf            n_compressed = compressBound(n_bytes);
        bytes.resize(begin + n_compressed);
        // More effort takes several times longer for files that are a few per
        // cent smaller.
        if (compress2(bytes.data() + begin,
                      &n_compressed,
                      block,
                      n_bytes,
                      Z_BEST_SPEED) != Z_OK)
          throw std::runtime_error("zlib cannot compress the fields");
        bytes.resize(begin + n_compressed);
        return n_compressed;
      }

      static constexpr std::size_t size_of_block = 1 << 20;

      std::vector<unsigned char> bytes;
    };



    void
    begin_file(const std::string &type,
               const bool         is_compressed,
               std::ostream      &out)
    {
      out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type
          << "\" version=\"1.0\" byte_order=\""
          << (boost::endian::order::native == boost::endian::order::little ?
                "LittleEndian" :
                "BigEndian")
          << "\" header_type=\"UInt64\"";
      if (is_compressed)
        out << " compressor=\"vtkZLibDataCompressor\"";
      out << ">\n<" << type << (is_compressed ? ">\n" : " GhostLevel=\"0\">\n");
    }



    template <typename Number>
    void
    describe(const std::string         &name,
             const unsigned int         n_components,
             const std::vector<Number> &numbers,
             AppendedData              &data,
             std::ostream              &out)
    {
      static_assert(std::is_same_v<Number, float> ||
                    std::is_same_v<Number, std::uint32_t> ||
                    std::is_same_v<Number, std::uint8_t>);
      const std::string type = std::is_same_v<Number, float> ? "Float32" :
                               sizeof(Number) == 4           ? "Int32" :
                                                               "UInt8";
      out << "<DataArray type=\"" << type << "\" Name=\"" << name
          << "\" NumberOfComponents=\"" << n_components
          << "\" format=\"appended\" offset=\"" << data.add(numbers)
          << "\"/>\n";
    }



    void
    describe(const std::string                 &where,
             const std::vector<VtuGrid::Field> &fields,
             AppendedData                      &data,
             std::ostream                      &out)
    {
      out << '<' << where << ">\n";
      for (const VtuGrid::Field &field : fields)
        describe(field.name, field.n_components, field.numbers, data, out);
      out << "</" << where << ">\n";
    }
  } // namespace



  unsigned int
  n_points(const VtuGrid::CellType type)
  {
    switch (type)
      {
        case VtuGrid::CellType::line:
          return 2;
        case VtuGrid::CellType::triangle:
          return 3;
        case VtuGrid::CellType::quadrilateral:
        case VtuGrid::CellType::tetrahedron:
          return 4;
        case VtuGrid::CellType::quadratic_triangle:
          return 6;
        case VtuGrid::CellType::quadratic_tetrahedron:
          return 10;
      }
    AssertThrow(false, dealii::ExcInternalError());
    return 0;
  }



  void
  write_vtu(const VtuGrid &grid, std::ostream &out)
  {
    const unsigned int n       = n_points(grid.type);
    const std::size_t  n_cells = grid.cells.size() / n;
    const auto has_fields      = [](const std::vector<VtuGrid::Field> &fields,
                               const std::size_t                  n_values) {
      return std::all_of(fields.begin(),
                         fields.end(),
                         [n_values](const VtuGrid::Field &field) {
                           return field.numbers.size() ==
                                  field.n_components * n_values;
                         });
    };
    AssertThrow(has_fields(grid.at_points, grid.points.size() / 3) &&
                  has_fields(grid.in_cells, n_cells),
                dealii::ExcInternalError());

    AppendedData data;
    begin_file("UnstructuredGrid", true, out);
    out << "<Piece NumberOfPoints=\"" << grid.points.size() / 3
        << "\" NumberOfCells=\"" << n_cells << "\">\n<Points>\n";
    describe("Points", 3, grid.points, data, out);
    out << "</Points>\n<Cells>\n";
    describe("connectivity", 1, grid.cells, data, out);
    std::vector<std::uint32_t> ends(n_cells);
    std::generate(ends.begin(), ends.end(), [n, end = 0U]() mutable {
      return end += n;
    });
    describe("offsets", 1, ends, data, out);
    describe("types",
             1,
             std::vector<std::uint8_t>(n_cells,
                                       static_cast<std::uint8_t>(grid.type)),
             data,
             out);
    out << "</Cells>\n";
    describe("PointData", grid.at_points, data, out);
    describe("CellData", grid.in_cells, data, out);
    out << "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    data.write(out);
    out << "\n</AppendedData>\n</VTKFile>\n";
  }



  void
  write_pvtu(const VtuGrid                  &grid,
             const std::vector<std::string> &pieces,
             std::ostream                   &out)
  {
    const auto describe = [&out](const std::string                 &where,
                                 const std::vector<VtuGrid::Field> &fields) {
      out << "<P" << where << ">\n";
      for (const VtuGrid::Field &field : fields)
        out << "<PDataArray type=\"Float32\" Name=\"" << field.name
            << "\" NumberOfComponents=\"" << field.n_components << "\"/>\n";
      out << "</P" << where << ">\n";
    };
    begin_file("PUnstructuredGrid", false, out);
    out << "<PPoints>\n<PDataArray type=\"Float32\" Name=\"Points\" "
           "NumberOfComponents=\"3\"/>\n</PPoints>\n";
    describe("PointData", grid.at_points);
    describe("CellData", grid.in_cells);
    for (const std::string &piece : pieces)
      out << "<Piece Source=\"" << piece << "\"/>\n";
    out << "</PUnstructuredGrid>\n</VTKFile>\n";
  }
} // namespace Debond
