#include "sss/geom/mesh_io.h"

#include "sss/base/error.h"
#include "sss/base/require_memory.h"
#include "sss/geom/face_collector.h"
#include "sss/geom/mesh_sieve.h"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <fmt/core.h>

// Registers the readers; must follow IOManager.hh.
#include <OpenMesh/Core/IO/MeshIO.hh>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <istream>
#include <mutex>
#include <streambuf>

namespace sss {

namespace {

namespace om = OpenMesh;

enum class Format { Obj, Ply, Stl, Off };

// What reading takes at the least for each byte of a file: itself, and what is made of it.
constexpr std::uint64_t kBytesPerByte = 2;
// Counts of what is in it then fit into 32 bits, whatever the format.
constexpr std::uint64_t kMostFileBytes = std::uint64_t{64} << 30;

/// Receives what a reader finds; OpenMesh's own importer would put it into a half-edge mesh, which
/// refuses faces at non-manifold edges.
class CollectingImporter final : public om::IO::BaseImporter {
public:
    explicit CollectingImporter(FaceCollector& collector) : collector_(collector) {}

    om::VertexHandle add_vertex(const om::Vec3f& p) override {
        return handle(collector_.addVertex({p[0], p[1], p[2]}));
    }
    om::VertexHandle add_vertex() override { return handle(collector_.addVertex(Vec3{0})); }
    void set_point(om::VertexHandle v, const om::Vec3f& p) override {
        collector_.setPosition(index(v), {p[0], p[1], p[2]});
    }
    om::FaceHandle add_face(const VHandles& corners) override {
        indices_.clear();
        for (const om::VertexHandle& v : corners) indices_.push_back(index(v));
        collector_.addFace(indices_);
        return om::FaceHandle(static_cast<int>(collector_.faceCount() - 1));
    }
    std::size_t n_vertices() const override { return collector_.vertexCount(); }
    std::size_t n_faces() const override { return collector_.faceCount(); }
    std::size_t n_edges() const override { return 0; }

    // Nothing below concerns us; normals come from the sieve.
    void set_normal(om::VertexHandle, const om::Vec3f&) override {}
    void set_normal(om::VertexHandle, const om::Vec3d&) override {}
    om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override {
        return om::HalfedgeHandle();
    }
    om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
    void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                            const std::vector<om::Vec2f>&) override {}
    void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                            const std::vector<om::Vec3f>&) override {}
    void set_face_texindex(om::FaceHandle, int) override {}
    void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
    void set_color(om::VertexHandle, const om::Vec3uc&) override {}
    void set_color(om::VertexHandle, const om::Vec4uc&) override {}
    void set_color(om::VertexHandle, const om::Vec3f&) override {}
    void set_color(om::VertexHandle, const om::Vec4f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec2f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec3f&) override {}
    void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
    void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
    void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
    void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec3f&) override {}
    void set_color(om::EdgeHandle, const om::Vec4f&) override {}
    void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_normal(om::FaceHandle, const om::Vec3f&) override {}
    void set_normal(om::FaceHandle, const om::Vec3d&) override {}
    void set_color(om::FaceHandle, const om::Vec3uc&) override {}
    void set_color(om::FaceHandle, const om::Vec4uc&) override {}
    void set_color(om::FaceHandle, const om::Vec3f&) override {}
    void set_color(om::FaceHandle, const om::Vec4f&) override {}
    void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
    void add_texture_information(int, std::string) override {}

private:
    static om::VertexHandle handle(std::uint32_t v) {
        return om::VertexHandle(static_cast<int>(v));
    }
    static std::uint32_t index(om::VertexHandle v) { return static_cast<std::uint32_t>(v.idx()); }

    FaceCollector& collector_;
    std::vector<std::uint32_t> indices_;
};

/// Reads a string in place; the PLY reader goes back after the header.
class StringBuffer final : public std::streambuf {
public:
    explicit StringBuffer(std::string& bytes) {
        setg(bytes.data(), bytes.data(), bytes.data() + bytes.size());
    }

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                     std::ios_base::openmode) override {
        const char* base = from == std::ios_base::beg   ? eback()
                           : from == std::ios_base::cur ? gptr()
                                                        : egptr();
        const off_type target = base - eback() + offset;
        if (target < 0 || target > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + target, egptr());
        return pos_type(target);
    }
    pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
        return seekoff(off_type(position), std::ios_base::beg, mode);
    }
};

/// Keeps OpenMesh from printing while it lives.
class QuietOpenMesh {
public:
    QuietOpenMesh() {
        for (std::size_t i = 0; i < 3; ++i) {
            was_[i] = stream(i).is_enabled();
            stream(i).disable();
        }
    }
    ~QuietOpenMesh() {
        for (std::size_t i = 0; i < 3; ++i)
            if (was_[i]) stream(i).enable();
    }
    QuietOpenMesh(const QuietOpenMesh&) = delete;
    QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

private:
    static om::mostream& stream(std::size_t i) {
        return i == 0 ? omlog() : i == 1 ? omout() : omerr();
    }
    std::array<bool, 3> was_{};
};

Format formatOf(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".obj") return Format::Obj;
    if (extension == ".ply") return Format::Ply;
    if (extension == ".stl") return Format::Stl;
    if (extension == ".off") return Format::Off;
    throw Error(ErrorKind::BadInput, path.string(),
                fmt::format("\"{}\" is not a mesh format that can be read", extension),
                "export as .obj, .ply, .stl or .off");
}

std::string readBytes(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw Error(ErrorKind::Io, path.string(), "no such mesh file",
                    "check the path, which is relative to the scene file");
    if (!std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::Io, path.string(), "this is no file", "name a mesh file");
    std::ifstream in(path, std::ios::binary);
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!in || error)
        throw Error(ErrorKind::Io, path.string(), "the mesh file cannot be opened",
                    "check its permissions");
    if (size > kMostFileBytes)
        throw Error(ErrorKind::BadInput, path.string(),
                    fmt::format("the mesh file has {:.3g} GB; at most {:.3g} can be used",
                                1e-9 * static_cast<double>(size),
                                1e-9 * static_cast<double>(kMostFileBytes)),
                    "simplify the mesh, or split it into several objects");
    requireMemory(path.string(),
                  fmt::format("a mesh file of {:.3g} GB", 1e-9 * static_cast<double>(size)),
                  kBytesPerByte * size, "simplify the mesh, or split it into several objects");
    std::string bytes(static_cast<std::size_t>(size), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        throw Error(ErrorKind::Io, path.string(), "the mesh file cannot be read to its end");
    return bytes;
}

/// Lets OpenMesh read `bytes` as binary PLY or STL.
FaceCollector runReader(const char* reader, std::string bytes, const std::string& where) {
    // OpenMesh's readers are single objects that keep the state of the file they read.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const QuietOpenMesh quiet;
    FaceCollector collector;
    CollectingImporter importer(collector);
    om::IO::Options options(om::IO::Options::Binary);
    StringBuffer buffer(bytes);
    std::istream stream(&buffer);
    // Where memory runs out in the midst of a word the stream would keep it to itself.
    stream.exceptions(std::ios_base::badbit);
    if (!om::IO::IOManager().read(stream, reader, importer, options))
        throw Error(ErrorKind::Internal, where, "OpenMesh refuses what the sieve let through",
                    "export it again, best as PLY");
    return collector;
}

[[noreturn]] void throwNoFaces(const std::string& where) {
    throw Error(ErrorKind::BadInput, where, "the mesh has no faces",
                "export a surface, not points or curves");
}

TriangleMesh readStl(std::string bytes, ReaderReport& report, const std::string& where) {
    SievedStl sieved = sieveStl(std::move(bytes), where);
    if (sieved.faces == 0) throwNoFaces(where);
    FaceCollector collector = runReader("stl", std::move(sieved.bytes), where);
    report.fileFaces = sieved.faces;
    report.fileVertices = 3 * sieved.faces;
    report.mergedVertices = report.fileVertices - collector.vertexCount();
    // This reader leaves out faces whose corners coincide by itself.
    report.droppedFaces = sieved.faces - collector.faceCount();
    return collector.build(nullptr, report, where, kMaxFaces);
}

TriangleMesh readIndexed(Format format, std::string bytes, ReaderReport& report,
                         const std::string& where) {
    SievedMesh sieved = format == Format::Obj   ? sieveObj(std::move(bytes), where)
                        : format == Format::Ply ? sievePly(bytes, where)
                                                : sieveOff(bytes, where);
    if (sieved.sizes.empty()) throwNoFaces(where);
    FaceCollector collector = runReader("ply", sieved.plainPly(), where);
    if (collector.vertexCount() != sieved.positions.size() ||
        collector.faceCount() != sieved.sizes.size() ||
        collector.cornerCount() != sieved.corners.size())
        throw Error(
            ErrorKind::Internal, where,
            fmt::format("OpenMesh delivered {} vertices, {} faces and {} corners of "
                        "{}, {} and {}",
                        collector.vertexCount(), collector.faceCount(), collector.cornerCount(),
                        sieved.positions.size(), sieved.sizes.size(), sieved.corners.size()));
    report.fileFaces = sieved.sizes.size();
    report.fileVertices = sieved.positions.size();
    return collector.build(&sieved, report, where, kMaxFaces);
}

}  // namespace

MeshFile readMesh(const std::filesystem::path& path) {
    const Format format = formatOf(path);
    const std::string where = path.string();
    std::string bytes = readBytes(path);
    ReaderReport reader;
    MeshFile file;
    file.mesh = format == Format::Stl ? readStl(std::move(bytes), reader, where)
                                      : readIndexed(format, std::move(bytes), reader, where);
    if (file.mesh.faces.empty())
        throw Error(
            ErrorKind::BadInput, where,
            fmt::format("none of its {} faces has three different corners", reader.fileFaces),
            "export a surface, not points or curves");
    file.report = inspectMesh(file.mesh);
    file.report.reader = reader;
    return file;
}

}  // namespace sss
