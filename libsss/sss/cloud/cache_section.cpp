#include "sss/cloud/cache_section.h"

#include "sss/base/error.h"
#include "sss/base/parallel.h"
#include "sss/cloud/cache_format.h"
#include "sss/cloud/mapped_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace sss {
namespace {

constexpr std::size_t kPartsPerTask = 16;

}  // namespace

SectionParts::SectionParts(std::string file, const SectionInfo& info,
                           std::span<const std::byte> bytes,
                           std::span<const std::uint64_t> checksums)
    : file_(std::move(file)),
      kind_(info.kind),
      body_(info.body),
      shift_(cachePartShift(info.elementBytes)),
      partBytes_(std::size_t{info.elementBytes} << shift_),
      bytes_(bytes),
      checksums_(checksums) {}

std::span<const std::byte> SectionParts::part(std::size_t index) const {
    const std::size_t first = index * partBytes_;
    return bytes_.subspan(first, std::min(partBytes_, bytes_.size() - first));
}

void SectionParts::check(std::size_t index) const {
    readSoon(part(index));
    if (checksum(part(index)) != checksums_[index])
        refuse(fmt::format("section '{}' of body {} is damaged (checksum)", kind_, body_));
}

void SectionParts::checkAll() const {
    readSoon(bytes_);
    parallelFor(count(), kPartsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) check(i);
    });
}

void SectionParts::refuse(const std::string& what) const {
    throw Error(ErrorKind::BadInput, file_, what, "run sss-preprocess again");
}

}  // namespace sss
