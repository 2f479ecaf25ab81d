#include "sss/geom/mesh_report.h"

#include "geom_tools.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <chrono>

namespace sss {
namespace {

bool mentions(const std::vector<std::string>& sentences, const std::string& words) {
    return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& sentence) {
        return sentence.find(words) != sentence.npos;
    });
}

TEST(MeshReport, FindsTheLongestHoleAndItsPlace) {
    // Two lids off a box: the larger hole is round (0, 0, 2), perimeter 10.
    TriangleMesh box = makeBox({2, 3, 4}, 0.5);
    std::erase_if(box.faces, [&](const UVec3& f) {
        const auto at = [&](int axis, double value) {
            return box.positions[f.x][axis] == value && box.positions[f.y][axis] == value &&
                   box.positions[f.z][axis] == value;
        };
        if (at(2, 2.0)) return true;
        // One cell in the middle of the opposite side.
        const DVec3 centre = (box.positions[f.x] + box.positions[f.y] + box.positions[f.z]) / 3.0;
        return at(2, -2.0) && std::abs(centre.x - 0.16) < 0.17 && std::abs(centre.y - 0.16) < 0.17;
    });
    const MeshReport report = inspectMesh(box);
    EXPECT_FALSE(report.closed);
    EXPECT_EQ(report.openLoops, 2u);
    ASSERT_EQ(report.longestLoops.size(), 2u);
    EXPECT_NEAR(report.longestLoops[0].length, 10, 1e-12);
    EXPECT_LT(glm::distance(report.longestLoops[0].centre, DVec3(0, 0, 2)), 1e-12);
    EXPECT_EQ(report.longestLoops[0].edges + report.longestLoops[1].edges, report.openEdges);
    EXPECT_GT(report.openLength, 10);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.closedComponents, 0u);
    const auto sentences = describe(report, 10);
    EXPECT_TRUE(mentions(sentences, "2 boundaries")) << sentences[0];
    EXPECT_TRUE(mentions(sentences, "mm in all (")) << sentences[0];
    EXPECT_TRUE(mentions(sentences, " edges, 100 mm around")) << sentences[0];
    EXPECT_TRUE(mentions(sentences, ", 20) mm")) << sentences[0];
}

// Seven sheets, each larger than the one before: five holes are named, the rest counted.
TEST(MeshReport, NamesTheFiveLongestHoles) {
    TriangleMesh sheets;
    for (int k = 1; k <= 7; ++k)
        sheets = testing::joined(sheets, testing::moved(makeRectangle(k, k), {10.0 * k, 0, 0}));
    const MeshReport report = inspectMesh(sheets);
    EXPECT_EQ(report.openLoops, 7u);
    ASSERT_EQ(report.longestLoops.size(), 5u);
    for (int k = 0; k < 5; ++k) {
        const OpenLoop& loop = report.longestLoops[static_cast<std::size_t>(k)];
        EXPECT_EQ(loop.edges, 4u);
        EXPECT_NEAR(loop.length, 4 * (7 - k), 1e-12);
        EXPECT_NEAR(loop.centre.x, 10 * (7 - k), 1e-12);
    }
    const std::vector<std::string> said = describe(report, 1);
    EXPECT_TRUE(mentions(said, "(4 edges, 28 mm around (70, 0, 0) mm; 4 edges, 24 mm around"))
        << said[0];
    EXPECT_TRUE(mentions(said, "around (30, 0, 0) mm; and 2 shorter)")) << said[0];
}

TEST(MeshReport, CountsAFanOfThreeOnOneEdge) {
    const TriangleMesh fan{{{0, 0, 0}, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}},
                           {},
                           {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    const MeshReport report = inspectMesh(fan);
    EXPECT_EQ(report.nonManifoldEdges, 1u);
    EXPECT_EQ(report.nonManifoldPlace, (DVec3{0, 0, 1}));
    EXPECT_EQ(report.openEdges, 6u);
    EXPECT_EQ(report.components, 3u);
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(mentions(describe(report, 1), "1 edge is shared by three or more"));
}

TEST(MeshReport, TwoBoxesThatTouchAlongAnEdgeAreClosed) {
    const TriangleMesh two =
        testing::joined(makeBox({2, 2, 2}), testing::moved(makeBox({2, 2, 2}), {2, 2, 0}));
    const MeshReport report = inspectMesh(two);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.nonManifoldEdges, 1u);
    EXPECT_EQ(report.flippedFaces, 0u);
}

TEST(MeshReport, EverySentenceSaysWhatToDo) {
    MeshReport bad;
    bad.openEdges = bad.openLoops = bad.nonManifoldEdges = bad.nonOrientable = 1;
    bad.flippedFaces = bad.degenerateFaces = bad.duplicateFaces = bad.unreferencedVertices = 2;
    bad.reader.droppedFaces = 1;
    bad.reader.ignoredNormals = true;
    const auto sentences = describe(bad, 1);
    EXPECT_EQ(sentences.size(), 9u);
    for (const std::string& sentence : sentences)
        EXPECT_TRUE(sentence.find("mesh editor") != sentence.npos ||
                    sentence.find("export") != sentence.npos)
            << sentence;
    EXPECT_TRUE(describe(MeshReport{}, 1).empty());
}

TEST(MeshReport, IsEmptyForAnEmptyMesh) {
    const MeshReport report = inspectMesh({});
    EXPECT_FALSE(report.closed);
    EXPECT_EQ(report.components, 0u);
}

}  // namespace
}  // namespace sss
