#include "sss/image/exr_file.h"

#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/require_memory.h"
#include "sss/image/exr_header.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/core.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>
#include <set>
#include <string_view>

namespace sss {
namespace {

constexpr int kZipLevel =
    1;  // lossless at any level; the higher ones cost more time than they save
constexpr int kMaximumSide = 1 << 17;
constexpr std::size_t kMaximumValues = std::size_t{1} << 30;  // 4 GiB of floats
// No compression of the format packs flat pictures tighter than this many values a byte.
constexpr std::size_t kMaximumValuesPerByte = 1 << 14;

// OpenEXR hands on by its words alone what its tasks throw, at the end of its own; before that it
// may quote the file, which can say anything.
void rethrowOutOfMemory(const std::exception& error) {
    if (std::string_view(error.what()).ends_with(std::bad_alloc().what())) throw std::bad_alloc();
}

// ---------------------------------------------------------------- writing

std::string channelName(const ImageLayer& layer, const std::string& channel) {
    const bool bare = layer.name.empty() || (layer.channels.size() == 1 && channel == layer.name);
    return bare ? channel : layer.name + "." + channel;
}

float storable(float value, float largest) {
    return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
}

struct AttributeInserter {
    Imf::Header& header;
    const std::string& name;
    void operator()(const std::string& text) const {
        header.insert(name, Imf::StringAttribute(text));
    }
    void operator()(double value) const {
        header.insert(name, Imf::FloatAttribute(static_cast<float>(value)));
    }
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(const std::array<double, 16>& values) const {
        Imath::M44f matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = static_cast<float>(values[static_cast<std::size_t>(i)]);
        header.insert(name, Imf::M44fAttribute(matrix));
    }
};

/// The layers' values as the file wants them; alive while OpenEXR's slices point into it.
class ChannelStore {
public:
    ChannelStore(const LayeredImage& image, bool halfPrecision) {
        for (const ImageLayer& layer : image.layers) {
            if (layer.values.size() != image.pixelCount() * layer.channels.size())
                throw Error(ErrorKind::Internal, "image",
                            fmt::format("layer \"{}\" has {} values for {} pixels", layer.name,
                                        layer.values.size(), image.pixelCount()));
            if (layer.fullPrecision || !halfPrecision)
                add(layer, image.width, Imf::FLOAT, floats_, std::numeric_limits<float>::max());
            else
                add(layer, image.width, Imf::HALF, halves_, HALF_MAX);
        }
    }
    const Imf::FrameBuffer& frameBuffer() const { return frameBuffer_; }
    const Imf::ChannelList& channels() const { return channels_; }

private:
    template <typename T>
    void add(const ImageLayer& layer, int width, Imf::PixelType type,
             std::vector<std::vector<T>>& store, float largest) {
        std::vector<T>& values = store.emplace_back(layer.values.size());
        std::ranges::transform(layer.values, values.begin(),
                               [&](float value) { return T(storable(value, largest)); });
        const std::size_t stride = sizeof(T) * layer.channels.size();
        for (std::size_t c = 0; c < layer.channels.size(); ++c) {
            const std::string name = channelName(layer, layer.channels[c]);
            channels_.insert(name, Imf::Channel(type));
            frameBuffer_.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data() + c),
                                                 stride, stride * static_cast<std::size_t>(width)));
        }
    }
    std::vector<std::vector<half>> halves_;
    std::vector<std::vector<float>> floats_;
    Imf::FrameBuffer frameBuffer_;
    Imf::ChannelList channels_;
};

// The numbers of a picture and its file's own structure: written by OpenEXR, not metadata.
bool isStructural(std::string_view name) {
    static const std::set<std::string_view> kNames{
        "channels",          "chromaticities",    "chunkCount", "compression", "dataWindow",
        "displayWindow",     "lineOrder",         "name",       "tiles",       "type",
        "pixelAspectRatio",  "preview",           "version",    "view",        "screenWindowCenter",
        "screenWindowWidth", "maxSamplesPerPixel"};
    return kNames.contains(name);
}

Imf::Header makeHeader(const LayeredImage& image, const Imf::ChannelList& channels) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = kZipLevel;
    header.channels() = channels;
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec.709 primaries, D65
    for (const auto& [name, value] : image.metadata) {
        if (isStructural(name))
            throw Error(
                ErrorKind::Internal, "image",
                fmt::format("metadata \"{}\" is a name that OpenEXR keeps for itself", name));
        std::visit(AttributeInserter{header, name}, value);
    }
    return header;
}

// ---------------------------------------------------------------- reading

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what,
                         const char* hint = "open it in another viewer and save it again") {
    throw Error(ErrorKind::BadInput, path.string(), what, hint);
}

/// "R", "G", "B", "A" and "X", "Y", "Z" in that order, then everything else by name.
std::size_t channelRank(const std::string& channel) {
    constexpr std::string_view kOrder = "RGBAXYZ";
    const std::size_t rank = channel.size() == 1 ? kOrder.find(channel) : std::string_view::npos;
    return std::min(rank, kOrder.size());
}

ImageLayer& layerFor(LayeredImage& image, const std::string& name) {
    for (ImageLayer& layer : image.layers)
        if (layer.name == name) return layer;
    return image.layers.emplace_back(ImageLayer{name, {}, {}, false});
}

struct ChannelPlace {
    std::string layer, channel;
};

ChannelPlace placeOf(const std::string& fullName) {
    static const std::set<std::string> kColours{"R", "G", "B", "A", "Y"};
    const std::size_t dot = fullName.rfind('.');
    if (dot != std::string::npos) return {fullName.substr(0, dot), fullName.substr(dot + 1)};
    return {kColours.contains(fullName) ? "" : fullName, fullName};
}

void requirePlausible(const std::filesystem::path& path, const ExrHeader& header) {
    const std::string size = fmt::format("{} x {} pixels with {} channels", header.width,
                                         header.height, header.channels);
    const std::size_t pixels =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    if (header.width > kMaximumSide || header.height > kMaximumSide ||
        pixels > kMaximumValues / header.channels)
        refuse(path, fmt::format("states {}, more than is read here", size), "scale it down");
    const std::size_t fileSize = std::filesystem::file_size(path);
    if (pixels * header.channels / kMaximumValuesPerByte > fileSize)
        refuse(path, fmt::format("states {} in only {} bytes: it is damaged", size, fileSize));
    requireMemory(path.string(), size, pixels * header.channels * sizeof(float), "scale it down");
}

LayeredImage emptyImageFor(const std::filesystem::path& path, const Imf::Header& header) {
    const Imath::Box2i window = header.dataWindow();
    LayeredImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            refuse(path, fmt::format("channel {} is subsampled", c.name()), "save it as plain RGB");
        const ChannelPlace place = placeOf(c.name());
        ImageLayer& layer = layerFor(image, place.layer);
        layer.channels.push_back(place.channel);
        layer.fullPrecision |= c.channel().type != Imf::HALF;
    }
    for (ImageLayer& layer : image.layers) {
        std::stable_sort(layer.channels.begin(), layer.channels.end(),
                         [](const std::string& a, const std::string& b) {
                             return channelRank(a) < channelRank(b);
                         });
        layer.values.resize(image.pixelCount() * layer.channels.size());
    }
    return image;
}

Imf::FrameBuffer slicesInto(LayeredImage& image, const Imf::Header& header) {
    Imf::FrameBuffer frameBuffer;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const ChannelPlace place = placeOf(c.name());
        ImageLayer& layer = layerFor(image, place.layer);
        const auto index = std::find(layer.channels.begin(), layer.channels.end(), place.channel) -
                           layer.channels.begin();
        const std::size_t stride = sizeof(float) * layer.channels.size();
        frameBuffer.insert(
            c.name(), Imf::Slice::Make(Imf::FLOAT, layer.values.data() + index, header.dataWindow(),
                                       stride, stride * static_cast<std::size_t>(image.width)));
    }
    return frameBuffer;
}

void readMetadata(const Imf::Header& header, LayeredImage& image) {
    for (auto a = header.begin(); a != header.end(); ++a) {
        if (isStructural(a.name())) continue;
        MetadataValue& value = image.metadata[a.name()];
        const Imf::Attribute& attribute = a.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            value = text->value();
        else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            value = static_cast<double>(single->value());
        else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
            value = number->value();
        else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            value = integer->value();
        else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            std::array<double, 16> values{};
            for (int i = 0; i < 16; ++i)
                values[static_cast<std::size_t>(i)] =
                    static_cast<double>(matrix->value()[i / 4][i % 4]);
            value = values;
        } else
            image.metadata.erase(a.name());
    }
}

}  // namespace

void writeExr(const std::filesystem::path& path, const LayeredImage& image,
              const ExrOptions& options) {
    const ChannelStore store(image, options.halfPrecision);
    const Imf::Header header = makeHeader(image, store.channels());
    AtomicFile file(path);
    try {
        // OpenEXR writes the table of offsets in a destructor, which swallows its errors; a stream
        // of ours remembers them.
        std::ofstream out(file.temporaryPath(), std::ios::binary);
        {
            Imf::StdOFStream stream(out, path.c_str());
            Imf::OutputFile exr(stream, header);
            exr.setFrameBuffer(store.frameBuffer());
            exr.writePixels(image.height);
        }
        out.close();
        if (!out) throw std::runtime_error("the disk or quota is full");
    } catch (const std::exception& error) {
        rethrowOutOfMemory(error);
        throw Error(ErrorKind::Io, path.string(),
                    fmt::format("cannot write the picture: {}", error.what()),
                    "check that the folder has room");
    }
    file.commit();
}

LayeredImage readExr(const std::filesystem::path& path) {
    requirePlausible(path, checkExrHeaders(path));
    try {
        // A process-wide limit of OpenEXR, always set to the same value: for the parts that are not
        // read.
        Imf::Header::setMaxImageSize(kMaximumSide, kMaximumSide);
        Imf::InputFile exr(path.c_str());
        LayeredImage image = emptyImageFor(path, exr.header());
        if (!exr.isComplete()) refuse(path, "is truncated", "copy or render it again");
        const Imath::Box2i window = exr.header().dataWindow();
        exr.setFrameBuffer(slicesInto(image, exr.header()));
        exr.readPixels(window.min.y, window.max.y);
        readMetadata(exr.header(), image);
        return image;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        rethrowOutOfMemory(error);
        refuse(path, fmt::format("cannot be read as OpenEXR: {}", error.what()));
    }
}

}  // namespace sss
