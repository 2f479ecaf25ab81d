#pragma once
#include "sss/base/json.h"
#include "sss/cloud/cache_file.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/preprocess.h"
#include "sss/integrate/scene_fingerprint.h"

namespace sss {

// What cache files say of a body, section by section: in one file for all bodies (cloud_cache.h) or
// in a file for each stage (stage_files.h).

/// Points, irradiance, octree and (if there is one) the solution on the body's shape, as sections
/// of body number `b`.
void addCloud(CacheWriter& writer, std::uint32_t b, const BodyInputs& inputs,
              const BodyCloud::View& cloud);
/// The same as they lie in the file, to be asked for part by part (CloudView::guard). Throws
/// Error{BadInput} if they do not fit each other, or what says so is damaged.
BodyCloud::View cloudOf(const CacheFile& file, std::uint32_t b, double spacingMm);
/// Diffusion on the shape of body `b`, for as many points. Throws Error{BadInput} as above.
std::span<const SolvedExitance> solvedOf(const CacheFile& file, std::uint32_t b,
                                         std::size_t points);
void addSolved(CacheWriter& writer, std::uint32_t b, const BodyInputs& inputs,
               std::span<const SolvedExitance> solved);

/// Beams by point.
void addBeams(CacheWriter& writer, const BodyInputs& inputs, const EnteredBeams& beams);
EnteredBeams beamsOf(const CacheFile& file, std::size_t points);

/// Points and their cells, from which light is gathered.
void addSamples(CacheWriter& writer, const BodyInputs& inputs, const SurfaceSamples& samples);
/// `faces`: of the body's mesh. Throws Error{BadInput} as above.
SurfaceSamples samplesOf(const CacheFile& file, std::size_t faces);

/// What a cache tells people of a body, and in "inputs" what it was made from.
JsonValue describeBody(const World& world, int body, const BodyReport& report,
                       const BodyInputs& inputs);
/// The report in it. Throws Error{BadInput} at `where` for what is missing.
BodyReport reportOf(const JsonValue& described, const std::string& where);

/// Metadata of a cache file. Throws Error{BadInput} if it has none.
JsonValue metadataOf(const CacheFile& file);
void addMetadata(CacheWriter& writer, const JsonValue& meta);

/// A member of an object in a file's metadata. Throws Error{BadInput}.
const JsonValue& metaMember(const JsonValue& object, std::string_view key,
                            const std::string& where);

}  // namespace sss
