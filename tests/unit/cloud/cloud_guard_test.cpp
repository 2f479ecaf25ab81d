#include "sss/cloud/cloud_guard.h"

#include "cloud_tools.h"
#include "sss/base/error.h"
#include "sss/base/parallel.h"
#include "sss/cloud/cache_file.h"
#include "sss/cloud/exitance_field.h"
#include "sss/geom/shapes.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <optional>

namespace sss {
namespace {

using testing::LitCloud;
using testing::Optics;
using testing::TemporaryFolder;

constexpr unsigned kNodeShift = cachePartShift(sizeof(OctreeNode));

// A bar so long that who looks at one end needs little of the other, in some parts of each kind.
struct Bar {
    Optics optics{"Ketchup"};
    TriangleMesh mesh = makeBox({60, 2, 2});
    LitCloud cloud{mesh, 0.23, testing::white};
    KernelTable table = cloud.table(optics, 70);
    std::vector<Vec3> end = nearEnd(cloud);
    TemporaryFolder folder;
    std::filesystem::path path = folder / "bar.ssc";

    Bar() { write(cloud.nodes, nodesBefore(cloud.nodes, kNodeShift)); }

    static std::vector<Vec3> nearEnd(const LitCloud& cloud) {
        std::vector<Vec3> places;
        for (const SurfacePoint& p : cloud.samples.points)
            if (p.position.x > 29 && places.size() < 64) places.push_back(p.position);
        return places;
    }
    void write(std::span<const OctreeNode> nodes, const std::vector<NodesBefore>& before) const {
        CacheWriter writer(path);
        writer.add<SurfacePoint>("points", 0, {}, cloud.samples.points);
        writer.add<Rgb>("irrad", 0, {}, cloud.irradiance);
        writer.add<OctreeNode>("octree", 0, {}, nodes);
        writer.add<NodesBefore>("before", 0, {}, before);
        writer.commit();
    }
    std::vector<Rgb> sumOver(const DiffusionSum& sum) const {
        std::vector<Rgb> out(end.size());
        DiffusionSum::Scratch scratch;
        SumCounts counts;
        sum.evaluate(end, 0.01, out, scratch, counts);
        return out;
    }
    std::vector<Rgb> truth() const { return sumOver({cloud.view(), cloud.nodes, table}); }
};

// The cloud of a bar as it lies in its file.
struct InFile {
    CacheFile file;
    CloudSections sections;
    CloudView view;

    explicit InFile(const std::filesystem::path& path)
        : file(CacheFile::open(path)),
          sections{file.unchecked<SurfacePoint>("points", 0), file.unchecked<Rgb>("irrad", 0),
                   file.unchecked<OctreeNode>("octree", 0), file.section<NodesBefore>("before", 0)},
          view{sections.points.elements, sections.irradiance.elements,
               std::make_shared<const CloudGuard>(sections)} {}
    DiffusionSum sum(const KernelTable& table) const {
        return {view, sections.nodes.elements, table};
    }
    std::uint64_t bytes() const {
        return sections.points.parts.bytes().size() + sections.irradiance.parts.bytes().size() +
               sections.nodes.parts.bytes().size();
    }
};

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        return error.what();
    }
    return "";
}

TEST(CloudGuard, SumsAreTheSameAndReadWhatTheyNeed) {
    const Bar bar;
    const InFile stored(bar.path);
    ASSERT_GT(stored.sections.nodes.parts.count(), 4u);
    const std::uint64_t before = stored.view.guard->bytesChecked();
    EXPECT_EQ(before, stored.sections.nodes.parts.part(0).size());
    EXPECT_EQ(bar.sumOver(stored.sum(bar.table)), bar.truth());
    const std::uint64_t needed = stored.view.guard->bytesChecked();
    EXPECT_GT(needed, before);
    EXPECT_LT(needed, stored.bytes() / 2);
    stored.view.needAll();
    EXPECT_EQ(stored.view.guard->bytesChecked(), stored.bytes());
}

// What is damaged is never summed over: it is named, or nobody needed it.
TEST(CloudGuard, DamageIsNamedWhereItIsNeeded) {
    const Bar bar;
    const std::vector<Rgb> truth = bar.truth();
    const std::string whole = testing::readFile(bar.path);
    int named = 0, notNeeded = 0;
    const auto damage = [&](const SectionInfo& info) {
        const std::uint64_t partBytes = std::uint64_t{info.elementBytes}
                                        << cachePartShift(info.elementBytes);
        for (std::uint64_t at = 0; at < info.bytes; at += partBytes) {
            std::string bytes = whole;
            bytes[info.offset + at] = static_cast<char>(bytes[info.offset + at] ^ 4);
            testing::writeFile(bar.path, bytes);
            const std::string message = refusal([&] {
                EXPECT_EQ(bar.sumOver(InFile(bar.path).sum(bar.table)), truth);
                ++notNeeded;
            });
            if (!message.empty()) {
                ++named;
                EXPECT_NE(message.find("section '" + info.kind + "' of body 0 is damaged"),
                          std::string::npos)
                    << message;
            }
            EXPECT_NE(refusal([&] { InFile(bar.path).view.needAll(); }), "");
        }
    };
    const CacheFile undamaged = CacheFile::open(bar.path);
    for (const SectionInfo& info : undamaged.sections()) damage(info);
    EXPECT_GT(named, 3);
    EXPECT_GT(notNeeded, 3);
}

// Checksums hold, but what the nodes say would send sums astray: in any part of them.
TEST(CloudGuard, LiesInAnyPartAreRefused) {
    const Bar bar;
    const std::vector<NodesBefore> before = nodesBefore(bar.cloud.nodes, kNodeShift);
    using Lie = std::function<void(OctreeNode&)>;
    const Lie lies[] = {
        [](OctreeNode& n) { n.first = 0; },
        [](OctreeNode& n) { n.first += 1; },
        [](OctreeNode& n) { n.first = 0xffffffffu; },
        [](OctreeNode& n) { n.count += 1; },
        [](OctreeNode& n) { n.count -= 1; },
        [](OctreeNode& n) { n.count ^= OctreeNode::kLeaf; },
        [](OctreeNode& n) { n.flux.y = NAN; },
    };
    const auto isRefused = [&](std::span<const OctreeNode> nodes,
                               const std::vector<NodesBefore>& parts) {
        bar.write(nodes, parts);
        return refusal([&] {
                   InFile(bar.path).view.needAll();
               }).find("the octree of body 0 does not fit its points") != std::string::npos;
    };
    const auto isInner = [&](std::size_t n) { return !bar.cloud.nodes[n].isLeaf(); };
    std::size_t parts = 0;
    for (std::size_t first = 0; first < bar.cloud.nodes.size(); first += 1u << kNodeShift) {
        std::size_t victim = first;
        while (victim < bar.cloud.nodes.size() && !isInner(victim)) ++victim;
        if (victim == bar.cloud.nodes.size()) break;
        ++parts;
        for (const Lie& lie : lies) {
            std::vector<OctreeNode> nodes = bar.cloud.nodes;
            lie(nodes[victim]);
            EXPECT_TRUE(isRefused(nodes, before)) << victim << ' ' << (&lie - lies);
        }
    }
    EXPECT_GT(parts, 3u);
    // The list of what came before each part lies as well.
    const std::function<void(std::vector<NodesBefore>&)> listLies[] = {
        [](auto& list) { list[0].children = 0; },
        [](auto& list) { list[1].children -= 1; },
        [](auto& list) { list[2].points += 1; },
        [](auto& list) { list[2].children = 0xffffffffu; },
        [](auto& list) { std::swap(list[1], list[3]); },
        [](auto& list) { list.pop_back(); },
        [](auto& list) { list.clear(); },
    };
    for (const auto& lie : listLies) {
        std::vector<NodesBefore> list = before;
        lie(list);
        EXPECT_TRUE(isRefused(bar.cloud.nodes, list)) << (&lie - listLies);
    }
    EXPECT_FALSE(isRefused(bar.cloud.nodes, before));
}

// Threads that ask for the same sites all hear of the damage: none waits for ever.
TEST(CloudGuard, FieldsPassDamageOn) {
    const Bar bar;
    std::string bytes = testing::readFile(bar.path);
    const SectionInfo points = *CacheFile::open(bar.path).find("points", 0);
    for (std::size_t at = 0; at < points.bytes; at += 1000)
        bytes[points.offset + at] = static_cast<char>(bytes[points.offset + at] ^ 4);
    testing::writeFile(bar.path, bytes);
    const InFile stored(bar.path);
    const DiffusionSum sum = stored.sum(bar.table);
    const ExitanceField field(bar.mesh, sum, 1.0, 0.01);
    constexpr std::size_t kAskers = 64;
    std::atomic<int> heard{0};
    parallelFor(kAskers, 1, [&](std::size_t, std::size_t) {
        if (!refusal([&] { field.at(0, Vec2(0.3f)); }).empty()) ++heard;
    });
    EXPECT_EQ(heard, static_cast<int>(kAskers));
    EXPECT_EQ(field.counts().groups, 0u);
}

}  // namespace
}  // namespace sss
