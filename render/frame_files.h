#pragma once
#include "options.h"
#include "sss/base/hash.h"
#include "sss/image/image.h"
#include "sss/scene/scene.h"

/// Where a frame's files go, and what they must hold.
struct PictureFrame {
    int number = 1;
    std::filesystem::path output, png;
    sss::Fingerprint picture;
};

/// The frame's names, without its fingerprint.
PictureFrame frameOf(const RenderOptions& options, int number);

/// Throws Error{Io} if a file of the frame could not be written.
void requireWritable(const RenderOptions& options, const PictureFrame& frame);

/// Writes the preview and then the EXR, so that where the EXR is whole, so is the frame.
void writePictures(const RenderOptions& options, const sss::Scene& scene, const PictureFrame& frame,
                   sss::LayeredImage& image, sss::Reporter& reporter);

/// Whether the pictures of this very frame are there, whole to the last pixel.
bool isComplete(const RenderOptions& options, const sss::Scene& scene, const PictureFrame& frame);
