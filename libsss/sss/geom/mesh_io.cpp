#include "sss/geom/mesh_io.h"

#include "sss/base/error.h"
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
    void set_normal(om::VertexHandle v, const om::Vec3f& n) override {
        // Only the OBJ reader comes here (see SievedMesh): corner by corner, just before the face.
        collector_.setCornerNormal(index(v), {n[0], n[1], n[2]});
    }
    void set_normal(om::VertexHandle v, const om::Vec3d& n) override {
        set_normal(v, om::Vec3f(n));
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

    // Nothing below concerns geometry.
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

/// Reads a string in place; the OBJ reader passes over it twice.
class StringBuffer final : public std::streambuf {
public:
    explicit StringBuffer(std::string& bytes) {
        setg(bytes.data(), bytes.data(), bytes.data() + bytes.size());
    }

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                     std::ios_base::openmode) override {
        const char* base = from == std::ios_base::beg ? eback()
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

const char* readerName(Format format) {
    switch (format) {
        case Format::Obj: return "obj";
        case Format::Ply: return "ply";
        case Format::Stl: return "stl";
        case Format::Off: break;
    }
    return "off";
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
    std::string bytes(static_cast<std::size_t>(size), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        throw Error(ErrorKind::Io, path.string(), "the mesh file cannot be read to its end");
    return bytes;
}

SievedMesh sieve(Format format, std::string bytes, const std::string& where) {
    switch (format) {
        case Format::Obj: return sieveObj(std::move(bytes), where);
        case Format::Ply: return sievePly(bytes, where);
        case Format::Stl: return sieveStl(std::move(bytes), where);
        case Format::Off: break;
    }
    return sieveOff(bytes, where);
}

/// Lets OpenMesh read `source`; false if it says that it could not.
bool runReader(Format format, SievedMesh& source, FaceCollector& collector) {
    // OpenMesh's readers are single objects that keep the state of the file they read.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const QuietOpenMesh quiet;
    CollectingImporter importer(collector);
    om::IO::Options options(om::IO::Options::VertexNormal);
    if (source.binary) options += om::IO::Options::Binary;
    StringBuffer buffer(source.bytes);
    std::istream stream(&buffer);
    return om::IO::IOManager().read(stream, readerName(format), importer, options);
}

}  // namespace

MeshFile readMesh(const std::filesystem::path& path) {
    const Format format = formatOf(path);
    const std::string where = path.string();
    SievedMesh source = sieve(format, readBytes(path), where);
    if (source.faces == 0)
        throw Error(ErrorKind::BadInput, where, "the mesh has no faces",
                    "export a surface, not points or curves");

    FaceCollector collector;
    const bool done = runReader(format, source, collector);
    source.bytes = {};
    const bool allVertices =
        format == Format::Stl || collector.vertexCount() == source.positions.size();
    if (!done || !allVertices || collector.faceCount() > source.faces)
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("OpenMesh read {} vertices and {} faces of {} and {}",
                                collector.vertexCount(), collector.faceCount(),
                                source.positions.size(), source.faces),
                    "export the mesh again, best as PLY");

    ReaderReport read;
    read.fileFaces = source.faces;
    read.fileVertices = format == Format::Stl ? 3 * source.faces : source.positions.size();
    read.simplifiedPolygons = source.repeating;
    if (format == Format::Stl) read.mergedVertices = read.fileVertices - collector.vertexCount();
    // The OBJ and STL readers leave out faces of fewer than three different corners themselves.
    read.droppedFaces = source.faces - collector.faceCount();
    MeshFile file;
    file.mesh = collector.build({std::move(source.positions), std::move(source.normals)}, read, where);
    if (file.mesh.faces.empty())
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("none of its {} faces has three different corners", source.faces),
                    "export a surface, not points or curves");
    file.report = inspectMesh(file.mesh);
    file.report.reader = read;
    return file;
}

}  // namespace sss
