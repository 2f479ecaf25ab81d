// Exitance kept for the next frame: the same bytes, no sum twice, and nothing stale.
#include "sss/integrate/exitance_cache.h"

#include "sss/cloud/exitance_store.h"
#include "sss/integrate/cloud_cache.h"
#include "support/temporary_folder.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace sss {
namespace {

using testing::MadeClouds;
using testing::measured;
using testing::SceneMaker;
using testing::TemporaryFolder;

Scene lampOverBox() {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(5)}, maker.material(measured("Marble")));
    maker.light(DirectionalLight{{0, -1, -1}, Rgb(2)});
    maker.scene.quality.spacingMm = 0.7;
    maker.scene.quality.irradianceSamples = 4;
    maker.scene.quality.tolerance = 0.05;
    return maker.scene;
}

struct Warnings final : Reporter {
    std::vector<std::string> all;
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view sentence) override { all.emplace_back(sentence); }
    void progress(std::string_view, double, double, bool) override {}
};

std::vector<Fingerprint> exitanceFingerprints(const World& world,
                                              std::span<const std::unique_ptr<BodyOptics>> optics) {
    std::vector<Fingerprint> all;
    for (const BodyInputs& inputs : worldInputs(world, optics))
        all.push_back(exitanceFingerprint(world, static_cast<int>(all.size()), inputs));
    return all;
}

// A scene with its fields, as sss-render has them.
struct Frame {
    SilentReporter silent;
    Warnings warnings;
    World world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
    MadeClouds made;
    std::vector<std::unique_ptr<BodyField>> fields;
    ExitanceCache cache;

    Frame(const Scene& scene, const std::filesystem::path& file)
        : world(scene, silent),
          optics(makeBodyOptics(world)),
          made(world, optics),
          cache(exitanceFileOf(file), exitanceFingerprints(world, optics)) {
        for (std::size_t b = 0; b < optics.size(); ++b)
            fields.push_back(std::make_unique<BodyField>(
                world.bodies()[b], *optics[b], made.clouds[b].view(), scene.quality.tolerance));
    }
    std::uint64_t load() { return cache.load(fields, warnings); }
    void save() { cache.save(fields, warnings); }
    /// Exitance of some faces; what a frame would ask for.
    std::vector<Rgb> look(FaceIndex first, FaceIndex end) {
        std::vector<Rgb> seen;
        for (FaceIndex f = first; f < end; ++f)
            for (const float x : {0.05f, 0.4f, 0.7f})
                seen.push_back(fields[0]->exitance(f, {x, 0.2f}));
        return seen;
    }
    ExitanceCounts counts() const { return fields[0]->counts(); }
};

bool sameBytes(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

// How light leans that leaves a body whose diffusion was solved on its shape is kept as well.
TEST(ExitanceCache, KeepsHowLightLeans) {
    const TemporaryFolder folder;
    SceneMaker maker;
    TranslucentMaterial material = measured("Marble");
    material.onShape = true;
    material.singleScattering = false;
    maker.object(BoxShape{DVec3(3)}, maker.material(material));
    maker.light(DirectionalLight{{-1, -1, -1}, Rgb(2)});
    maker.scene.quality.spacingMm = 0.7;
    maker.scene.quality.irradianceSamples = 4;
    maker.scene.quality.tolerance = 0.05;
    const auto look = [](const Frame& frame) {
        std::vector<Rgb> seen;
        for (FaceIndex f = 0; f < 12; ++f)
            for (const Vec3& towards : {Vec3(0.8f, 0, 0.6f), Vec3(-0.6f, 0.8f, 0)})
                seen.push_back(frame.fields[0]->exitance(f, {0.3f, 0.2f}, towards));
        return seen;
    };
    Frame first(maker.scene, folder / "c.ssc");
    const std::vector<Rgb> expected = look(first);
    first.save();
    Frame second(maker.scene, folder / "c.ssc");
    EXPECT_EQ(second.load(), first.counts().groups);
    EXPECT_TRUE(sameBytes(look(second), expected));
    EXPECT_EQ(second.counts().groups, 0u);
    EXPECT_NE(expected[0], expected[1]);
}

std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(ExitanceCache, ASecondFrameLooksUpTheSameBytes) {
    const TemporaryFolder folder;
    const Scene scene = lampOverBox();
    Frame first(scene, folder / "c.ssc");
    EXPECT_EQ(first.load(), 0u);
    const std::vector<Rgb> expected = first.look(0, 12);
    first.save();

    Frame second(scene, folder / "c.ssc");
    EXPECT_EQ(second.load(), first.counts().groups);
    EXPECT_TRUE(sameBytes(second.look(0, 12), expected));
    EXPECT_EQ(second.counts().groups, 0u);
    EXPECT_EQ(second.counts().sums.receivers, 0u);
    const auto written = std::filesystem::last_write_time(second.cache.file());
    second.save();
    EXPECT_EQ(std::filesystem::last_write_time(second.cache.file()), written);
    EXPECT_TRUE(second.warnings.all.empty());
}

TEST(ExitanceCache, FramesAddWhatTheySeeForTheFirstTime) {
    const TemporaryFolder folder;
    const Scene scene = lampOverBox();
    Frame whole(scene, folder / "whole.ssc");
    const std::vector<Rgb> expected = whole.look(0, 12);
    whole.save();
    // Two at once: neither has seen the other's part when it starts.
    Frame one(scene, folder / "c.ssc"), other(scene, folder / "c.ssc");
    EXPECT_EQ(one.load() + other.load(), 0u);
    one.look(0, 5);
    other.look(5, 12);
    one.save();
    other.save();
    EXPECT_EQ(bytesOf(other.cache.file()), bytesOf(whole.cache.file()));
    Frame later(scene, folder / "c.ssc");
    later.load();
    EXPECT_TRUE(sameBytes(later.look(0, 12), expected));
    EXPECT_EQ(later.counts().groups, 0u);
}

// From afar a body may be in its diffuse limit and have no field; what is known of it stays.
TEST(ExitanceCache, KeepsWhatAFrameDoesNotWant) {
    const TemporaryFolder folder;
    Scene scene = lampOverBox();
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].name = "other";
    scene.objects[1].transform = {testing::moved({20, 0, 0})};
    Frame near(scene, folder / "c.ssc");
    near.look(0, 3);
    near.fields[1]->exitance(0, {0.2f, 0.2f});
    near.save();
    const std::uint64_t first = near.counts().groups, other = near.fields[1]->counts().groups;
    ASSERT_GT(other, 0u);

    Frame far(scene, folder / "c.ssc");
    far.fields[1].reset();
    EXPECT_EQ(far.load(), first);
    far.look(0, 12);
    const std::uint64_t added = far.counts().groups;
    ASSERT_GT(added, 0u);
    far.save();
    EXPECT_EQ(Frame(scene, folder / "c.ssc").load(), first + other + added);
}

TEST(ExitanceCache, NothingStaleIsUsed) {
    const TemporaryFolder folder;
    const Scene scene = lampOverBox();
    Frame first(scene, folder / "c.ssc");
    first.look(0, 12);
    first.save();
    const auto groupsFor = [&](auto change) {
        Scene other = scene;
        change(other);
        return Frame(other, folder / "c.ssc").load();
    };
    EXPECT_GT(groupsFor([](Scene& s) { s.camera.position.x += 1; }), 0u);
    EXPECT_EQ(groupsFor([](Scene& s) { s.quality.tolerance = 0.04; }), 0u);
    EXPECT_EQ(groupsFor([](Scene& s) { s.quality.spacingMm = 0.8; }), 0u);
    EXPECT_EQ(
        groupsFor([](Scene& s) { std::get<DirectionalLight>(s.lights[0]).irradiance = Rgb(3); }),
        0u);
    EXPECT_EQ(groupsFor([](Scene& s) {
                  std::get<TranslucentMaterial>(s.materials[0].material).medium.sigmaA.x = 1;
              }),
              0u);
}

TEST(ExitanceCache, ADamagedFileIsNamedAndMadeAnew) {
    const TemporaryFolder folder;
    const Scene scene = lampOverBox();
    Frame first(scene, folder / "c.ssc");
    first.look(0, 12);
    first.save();
    const std::string whole = bytesOf(first.cache.file());
    for (const std::size_t at : {std::size_t{3}, whole.size() / 2, whole.size() - 9}) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        std::ofstream(first.cache.file(), std::ios::binary) << damaged;
        Frame second(scene, folder / "c.ssc");
        EXPECT_EQ(second.load(), 0u);
        ASSERT_EQ(second.warnings.all.size(), 1u);
        EXPECT_NE(second.warnings.all[0].find("c.ssc.exitance"), std::string::npos);
        second.look(0, 12);
        second.save();
        EXPECT_EQ(bytesOf(first.cache.file()), whole);
    }
}

// Its checksums hold, so that another program wrote it.
TEST(ExitanceCache, AFileThatDoesNotFitTogetherIsNamed) {
    const TemporaryFolder folder;
    const Scene scene = lampOverBox();
    Frame first(scene, folder / "c.ssc");
    first.look(0, 12);
    first.save();
    const auto fingerprint = CacheFile::open(first.cache.file()).find("exgroups", 0)->fingerprint;
    {
        CacheWriter writer(first.cache.file());
        writer.add<ExitanceStore::Entry>("exgroups", 0, fingerprint,
                                         std::vector<ExitanceStore::Entry>(1, {7, 1}));
        writer.add<std::uint8_t>("exsegms", 0, {}, std::vector<std::uint8_t>());
        writer.add<std::uint16_t>("exsites", 0, {}, std::vector<std::uint16_t>());
        writer.add<Rgb>("exvalues", 0, {}, std::vector<Rgb>());
        writer.commit();
    }
    Frame second(scene, folder / "c.ssc");
    EXPECT_EQ(second.load(), 0u);
    ASSERT_EQ(second.warnings.all.size(), 1u);
    EXPECT_NE(second.warnings.all[0].find("the exitance of body 0 does not fit together"),
              std::string::npos)
        << second.warnings.all[0];
}

TEST(ExitanceCache, WhatCannotBeWrittenIsNoFault) {
    const TemporaryFolder folder;
    Frame frame(lampOverBox(), folder / "no-such-folder/c.ssc");
    EXPECT_EQ(frame.load(), 0u);
    frame.look(0, 2);
    frame.save();
    EXPECT_TRUE(frame.warnings.all.empty());
}

// Arrays with whole checksums that do not fit each other, or the mesh.
TEST(ExitanceStore, HandsOnWholeGroupsOnly) {
    Frame frame(lampOverBox(), "unused");
    frame.look(0, 3);
    ExitanceStore store;
    frame.fields[0]->field().forEachGroup(
        [&](std::uint32_t index, const ExitanceGroup& group) { store.add(index, group); });
    ASSERT_GT(store.entries.size(), 1u);
    const auto isRefused = [&](auto change) {
        ExitanceStore changed = store;
        change(changed);
        Frame fresh(lampOverBox(), "unused");
        return !forEachGroup(changed.view(), [&](std::uint32_t index, ExitanceGroup group) {
            return fresh.fields[0]->field().adopt(index, std::move(group));
        });
    };
    EXPECT_FALSE(isRefused([](ExitanceStore&) {}));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.values.pop_back(); }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.values.emplace_back(1.0f); }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.values[0].x = NAN; }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.slopes.resize(1); }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.slopes.resize(s.values.size()); }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.siteOf[2] = 60000; }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.segments[0] = 77; }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.entries[0].patches += 1; }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.entries[0].group = 1u << 30; }));
    EXPECT_TRUE(isRefused([](ExitanceStore& s) { s.entries[1].group = s.entries[0].group; }));
}

}  // namespace
}  // namespace sss
