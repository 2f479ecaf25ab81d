#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <memory>
#include <span>

namespace sss {

/// Nearest-neighbour queries over a fixed set of points (a FLANN k-d tree, exact).
class NearestPoints {
public:
    /// `points` must outlive this object; not empty.
    explicit NearestPoints(std::span<const Vec3> points);
    ~NearestPoints();
    NearestPoints(const NearestPoints&) = delete;
    NearestPoints& operator=(const NearestPoints&) = delete;

    static constexpr int kMost = 3;
    struct Neighbours {
        int count = 0;  ///< min(kMost, number of points)
        std::uint32_t index[kMost];
        float distanceSquaredMm2[kMost];  ///< ascending
    };
    /// The kMost nearest points of every query. Parallel; about 0.5 us a query and core.
    void query(std::span<const Vec3> queries, std::span<Neighbours> out) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sss
