#include "sss/cloud/nearest_points.h"

#include "sss/base/parallel.h"

#include <flann/flann.hpp>

#include <algorithm>
#include <vector>

namespace sss {
namespace {

constexpr int kLeafSize = 8;  // fastest of 4, 8, 16 on 100,000 points

flann::Matrix<float> matrixOf(std::span<const Vec3> points) {
    // FLANN takes non-const pointers but does not write to them.
    return {const_cast<float*>(&points.front().x), points.size(), 3};
}

}  // namespace

struct NearestPoints::Impl {
    flann::KDTreeSingleIndex<flann::L2_Simple<float>> index;
};

NearestPoints::NearestPoints(std::span<const Vec3> points)
    : impl_(new Impl{{matrixOf(points), flann::KDTreeSingleIndexParams(kLeafSize, true)}}) {
    impl_->index.buildIndex();
}

NearestPoints::~NearestPoints() = default;

void NearestPoints::query(std::span<const Vec3> queries, std::size_t count,
                          std::span<std::uint32_t> indices) const {
    parallelFor(queries.size(), kBatch, [&](std::size_t begin, std::size_t end) {
        const std::size_t batch = end - begin;
        std::vector<int> found(batch * count);
        std::vector<float> distances(batch * count);
        flann::Matrix<int> indexMatrix(found.data(), batch, count);
        flann::Matrix<float> distanceMatrix(distances.data(), batch, count);
        flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED);
        params.sorted = true;
        params.cores = 1;
        impl_->index.knnSearch(matrixOf(queries.subspan(begin, batch)), indexMatrix, distanceMatrix,
                               count, params);
        std::transform(found.begin(), found.end(),
                       indices.begin() + static_cast<std::ptrdiff_t>(begin * count),
                       [](int i) { return static_cast<std::uint32_t>(i); });
    });
}

}  // namespace sss
