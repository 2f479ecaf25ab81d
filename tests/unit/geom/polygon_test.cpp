#include "sss/geom/polygon.h"

#include "sss/base/rng.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

/// Sums of the triangles' areas, signed along the polygon's area vector and unsigned: equal where
/// no triangle leaves the polygon.
struct Areas {
    double net = 0, gross = 0, polygon = 0;
};
Areas areasOf(const std::vector<DVec3>& corners) {
    DVec3 vector{0};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        vector += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    Areas areas{0, 0, glm::length(vector) / 2};
    const DVec3 axis = glm::normalize(vector);
    for (const UVec3& t : triangulatePolygon(corners)) {
        const DVec3 cross = glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]);
        areas.net += glm::dot(cross, axis) / 2;
        areas.gross += glm::length(cross) / 2;
    }
    return areas;
}

TEST(Polygon, CutsConcaveOnesInsideThemselves) {
    const std::vector<DVec3> arrow{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}};
    const std::vector<DVec3> comb{{0, 0, 0}, {7, 0, 0}, {7, 3, 0}, {6, 3, 0}, {6, 1, 0}, {4, 1, 0},
                                  {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    for (std::vector<DVec3> corners : {arrow, comb})
        for (int turn = 0; turn < 6; ++turn) {
            // All axes and both windings.
            for (DVec3& p : corners) p = DVec3(p.y, p.z, p.x);
            if (turn == 3) std::reverse(corners.begin(), corners.end());
            for (std::size_t start = 0; start < corners.size(); ++start) {
                std::rotate(corners.begin(), corners.begin() + 1, corners.end());
                EXPECT_EQ(triangulatePolygon(corners).size(), corners.size() - 2);
                const Areas areas = areasOf(corners);
                EXPECT_NEAR(areas.net, areas.polygon, 1e-12);
                EXPECT_NEAR(areas.gross, areas.polygon, 1e-12);
            }
        }
}

TEST(Polygon, CutsARoundHoleTiedToItsRim) {
    const std::vector<DVec3> frame{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                                   {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
    const Areas areas = areasOf(frame);
    EXPECT_NEAR(areas.gross, 8, 1e-12);
}

TEST(Polygon, RandomStarsKeepTheirArea) {
    Rng rng(4);
    for (int round = 0; round < 100; ++round) {
        std::vector<DVec3> star;
        const int n = 5 + round;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * kPi * i / n, r = 0.2 + rng.uniformDouble();
            star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
        }
        const Areas areas = areasOf(star);
        EXPECT_NEAR(areas.gross, areas.polygon, 1e-12);
    }
}

TEST(Polygon, SelfCrossingOnesStillGiveAllTriangles) {
    const std::vector<DVec3> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1.5, 0}, {-1, 0.2, 0}};
    EXPECT_EQ(triangulatePolygon(bow).size(), 3u);
}

}  // namespace
}  // namespace sss
