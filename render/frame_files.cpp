#include "frame_files.h"

#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/frame_list.h"
#include "sss/image/exr_file.h"
#include "sss/image/png_file.h"
#include "sss/image/tone_map.h"

using namespace sss;

namespace {

constexpr const char* kPictureHash = "sss/pictureHash";

}  // namespace

PictureFrame frameOf(const RenderOptions& options, int number) {
    PictureFrame frame{number, frameName(options.output.string(), number), {}, {}};
    frame.png = frame.output;
    frame.png.replace_extension(".png");
    return frame;
}

void requireWritable(const RenderOptions& options, const PictureFrame& frame) {
    sss::requireWritable(frame.output);
    if (!options.noPng) sss::requireWritable(frame.png);
}

void writePictures(const RenderOptions& options, const Scene& scene, const PictureFrame& frame,
                   LayeredImage& image, Reporter& reporter) {
    image.metadata[kPictureHash] = frame.picture.hex();
    std::string files = frame.output.string();
    if (!options.noPng) {
        writePng(frame.png, toneMap(image, scene.film.exposureStops));
        files += " and " + frame.png.string();
    }
    writeExr(frame.output, image, {scene.film.halfPrecision});
    reporter.info("image", "wrote " + files);
}

bool isComplete(const RenderOptions& options, const Scene& scene, const PictureFrame& frame) {
    std::error_code ignored;
    if (!std::filesystem::exists(frame.output, ignored)) return false;
    if (!options.noPng && !isWholePng(frame.png)) return false;
    try {
        const LayeredImage image = readExr(frame.output);
        const auto hash = image.metadata.find(kPictureHash);
        const auto* text =
            hash == image.metadata.end() ? nullptr : std::get_if<std::string>(&hash->second);
        return text != nullptr && *text == frame.picture.hex() && image.width == scene.film.width &&
               image.height == scene.film.height;
    } catch (const Error&) {
        return false;
    }
}
