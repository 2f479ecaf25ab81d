#include "sss/base/error.h"
#include "sss/cloud/octree_check.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/cloud_sections.h"
#include "sss/integrate/scene_fingerprint.h"
#include "support/temporary_folder.h"
#include "unit/integrate/cache_maker.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <set>

namespace sss {
namespace {

using testing::MadeClouds;
using testing::measured;
using testing::SceneMaker;
using testing::TemporaryFolder;

SceneMaker smallScene() {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(5)}, maker.material(measured("Marble")));
    maker.object(RectangleShape{20, 20}, maker.material(LambertianMaterial{}),
                 testing::moved({0, 0, -6}));
    maker.light(DirectionalLight{{0, -1, -1}, Rgb(2)});
    maker.scene.quality.spacingMm = 0.7;
    maker.scene.quality.bounces = 1;
    maker.scene.quality.irradianceSamples = 12;
    return maker;
}

BodyInputs inputsOf(const Scene& scene) {
    SilentReporter silent;
    const World world(scene, silent);
    const auto optics = makeBodyOptics(world);
    return bodyInputs(world, 0, optics, pointSpacingMm(world, world.bodies()[0], *optics[0]));
}

VolumeSettings ballOfFog() {
    VolumeSettings fog;
    fog.name = "fog";
    fog.shape = SphereShape{9};
    fog.sigmaS = Rgb(0.1f);
    return fog;
}

// All of a volume that light on its way to a body can notice.
TEST(SceneFingerprint, KnowsVolumes) {
    const TemporaryFolder folder;
    const auto grid = [&](const char* name, char byte) {
        std::ofstream(folder / name) << std::string(32, byte);
        return GridFile{folder / name, 2, 2, 2, 1};
    };
    const std::function<void(VolumeSettings&)> changes[] = {
        [](VolumeSettings& v) { v.sigmaA.y = 0.2f; },
        [](VolumeSettings& v) { v.sigmaS.z = 0.2f; },
        [](VolumeSettings& v) { v.g = 0.3; },
        [](VolumeSettings& v) { v.sigmaA = Rgb(1), v.emission = Rgb(1); },
        [](VolumeSettings& v) { v.shape = BoxShape{DVec3(18)}; },
        [](VolumeSettings& v) { v.shape = SphereShape{8}; },
        [](VolumeSettings& v) {
            v.transform = {testing::moved({0, 1, 0})};
        },
        [&](VolumeSettings& v) { v.grid = grid("a.raw", 1); },
        [&](VolumeSettings& v) { v.grid = grid("b.raw", 2); },
    };
    std::set<std::string> seen;
    const auto look = [&](const VolumeSettings& volume) {
        Scene scene = smallScene().scene;
        scene.volumes = {volume};
        for (const InputFingerprint& input : inputsOf(scene))
            if (input.key == "volumes") seen.insert(input.value.hex());
    };
    look(ballOfFog());
    for (const auto& change : changes) {
        VolumeSettings volume = ballOfFog();
        change(volume);
        look(volume);
    }
    EXPECT_EQ(seen.size(), std::size(changes) + 1);
}

// Of its own medium, and of a neighbour's, the body that pass 1 is for knows what may reach it.
TEST(SceneFingerprint, KnowsMediaByWhatComesBack) {
    const auto withMedium = [](SceneMaker maker, std::size_t material, double sigmaA) {
        std::get<TranslucentMaterial>(maker.scene.materials[material].material).medium.sigmaA.z =
            sigmaA;
        return lightFingerprint(inputsOf(maker.scene));
    };
    const auto knows = [&](const SceneMaker& maker, std::size_t material) {
        return !(withMedium(maker, material, 1) == withMedium(maker, material, 2));
    };
    SceneMaker alone = smallScene();
    alone.scene.objects.pop_back();
    alone.scene.quality.bounces = 4;
    EXPECT_FALSE(knows(alone, 0));
    SceneMaker inFog = alone;
    inFog.scene.volumes.push_back(ballOfFog());
    EXPECT_TRUE(knows(inFog, 0));
    SceneMaker bent = alone;
    const TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n"
                                       "f 2 3 4\nf 1 4 3\n";
    bent.scene.objects[0].shape = MeshFileShape{folder / "a.obj"};
    EXPECT_TRUE(knows(bent, 0));
    SceneMaker byLamp = alone;
    byLamp.object(RectangleShape{20, 20}, byLamp.material(EmitterMaterial{}),
                  testing::moved({0, 0, -6}));
    EXPECT_FALSE(knows(byLamp, 0));
    SceneMaker onFloor = smallScene();
    for (const int bounces : {0, 1, 2}) {
        onFloor.scene.quality.bounces = bounces;
        EXPECT_EQ(knows(onFloor, 0), bounces == 2);
    }
    SceneMaker two = alone;
    two.object(BoxShape{DVec3(2)}, two.material(measured("Ketchup")), testing::moved({9, 0, 0}));
    for (const int bounces : {0, 1, 2}) {
        two.scene.quality.bounces = bounces;
        EXPECT_EQ(knows(two, 0), bounces == 2);
        EXPECT_EQ(knows(two, two.scene.materials.size() - 1), bounces > 0);
    }
}

// A medium scaled as a whole reflects the same, and so lights all bodies the same.
TEST(SceneFingerprint, KnowsNothingOfTheMediumsScale) {
    SceneMaker maker = smallScene();
    maker.scene.quality.bounces = 4;
    const auto before = lightFingerprint(inputsOf(maker.scene));
    auto& medium = std::get<TranslucentMaterial>(maker.scene.materials[0].material).medium;
    medium.sigmaA *= 4;  // powers of two are exact
    medium.sigmaS *= 4;
    EXPECT_EQ(lightFingerprint(inputsOf(maker.scene)), before);
    medium.sigmaA *= 4;
    EXPECT_NE(lightFingerprint(inputsOf(maker.scene)), before);
}

TEST(SceneFingerprint, NamesExactlyWhatChanged) {
    struct Change {
        const char* what;
        std::function<void(Scene&)> make;
        std::set<std::string> keys;
    };
    const Change changes[] = {
        {"nothing", [](Scene&) {}, {}},
        {"camera",
         [](Scene& s) {
             s.camera.position = {1, 2, 30};
         },
         {}},
        {"film", [](Scene& s) { s.film.samples = 7, s.film.width = 99; }, {}},
        {"all that light notices when it comes out only",
         [](Scene& s) {
             auto& m = std::get<TranslucentMaterial>(s.materials[0].material);
             m.roughness = 0.4;
             m.surfaceReflection = m.singleScattering = m.multipleScattering = false;
             m.energy = EnergyConvention::Jensen;
         },
         {}},
        {"eta",
         [](Scene& s) { std::get<TranslucentMaterial>(s.materials[0].material).medium.eta = 1.4; },
         {"medium"}},
        {"names", [](Scene& s) { s.objects[0].name = "ball", s.materials[0].name = "stone"; }, {}},
        {"light",
         [](Scene& s) { std::get<DirectionalLight>(s.lights[0]).irradiance.y = 3; },
         {"lights"}},
        {"another light", [](Scene& s) { s.lights.emplace_back(PointLight{}); }, {"lights"}},
        {"mesh", [](Scene& s) { s.objects[0].shape = BoxShape{DVec3(5.01)}; }, {"mesh", "form"}},
        {"medium",
         [](Scene& s) {
             std::get<TranslucentMaterial>(s.materials[0].material).medium.sigmaA.z = 1;
             s.quality.bounces = 2;
         },
         {"medium", "irradiance"}},
        {"medium, which does not come back in one bounce",
         [](Scene& s) {
             std::get<TranslucentMaterial>(s.materials[0].material).medium.sigmaA.z = 1;
         },
         {}},
        {"spacing", [](Scene& s) { s.quality.spacingMm = 0.8; }, {"sampling"}},
        {"seed", [](Scene& s) { s.quality.seed = 5; }, {"sampling"}},
        {"light samples", [](Scene& s) { s.quality.irradianceSamples = 24; }, {"irradiance"}},
        // Light may then come back to the body: what its medium reflects counts.
        {"bounces", [](Scene& s) { s.quality.bounces = 2; }, {"irradiance", "medium"}},
        {"neighbour's place",
         [](Scene& s) {
             s.objects[1].transform = {testing::moved({0, 0, -7})};
         },
         {"surroundings"}},
        {"neighbour's colour",
         [](Scene& s) { s.materials[1].material = LambertianMaterial{Rgb(0.1f)}; },
         {"surroundings"}},
        {"its own place",
         [](Scene& s) {
             s.objects[0].transform = {testing::turned(5, {0, 1, 0})};
         },
         {"lights", "surroundings"}},
        {"a new neighbour",
         [](Scene& s) {
             s.objects.push_back(s.objects[1]);
             s.objects.back().transform = {testing::moved({0, 0, -8})};
         },
         {"surroundings"}},
        {"fog", [](Scene& s) { s.volumes.push_back(ballOfFog()); }, {"volumes", "medium"}},
    };
    const auto before = inputsOf(smallScene().scene);
    for (const Change& change : changes) {
        SCOPED_TRACE(change.what);
        Scene scene = smallScene().scene;
        change.make(scene);
        const auto after = inputsOf(scene);
        ASSERT_EQ(after.size(), before.size());
        std::set<std::string> keys;
        for (std::size_t i = 0; i < after.size(); ++i) {
            EXPECT_EQ(after[i].key, before[i].key);
            if (!(after[i].value == before[i].value)) keys.insert(after[i].key);
        }
        EXPECT_EQ(keys, change.keys);
    }
}

struct Written {
    SceneMaker maker;
    World world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
    MadeClouds made;

    explicit Written(const std::filesystem::path& path)
        : maker(smallScene()),
          world(maker.world()),
          optics(makeBodyOptics(world)),
          made(world, optics) {
        testing::writeCache(path, world, optics, made.clouds, made.reports);
    }
};

std::string refusal(const std::filesystem::path& path, const Scene& scene) {
    SilentReporter silent;
    const World world(scene, silent);
    const auto optics = makeBodyOptics(world);
    try {
        const CloudCache cache(path, world, optics);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        return error.what();
    }
    return "not refused";
}

TEST(CloudCache, GivesThePictureOfTheCloudsInMemory) {
    const TemporaryFolder folder;
    const Written written(folder / "a.ssc");
    const CloudCache cache(folder / "a.ssc", written.world, written.optics);
    const LayeredImage file = testing::renderFrom(written.world, written.optics,
                                                  [&](std::size_t b) { return cache.view(b); });
    const LayeredImage memory =
        testing::renderFrom(written.world, written.optics,
                            [&](std::size_t b) { return written.made.clouds[b].view(); });
    for (const ImageLayer& layer : memory.layers)
        EXPECT_EQ(file.find(layer.name)->values, layer.values) << layer.name;
}

TEST(CloudCache, OfAnotherSceneIsRefusedWithTheReason) {
    const TemporaryFolder folder;
    const Written written(folder / "a.ssc");
    EXPECT_EQ(refusal(folder / "a.ssc", written.maker.scene), "not refused");
    const auto expectRefused = [&](const char* word, const std::function<void(Scene&)>& change) {
        Scene scene = written.maker.scene;
        change(scene);
        const std::string message = refusal(folder / "a.ssc", scene);
        EXPECT_NE(message.find("made for another scene"), std::string::npos) << message;
        EXPECT_NE(message.find(word), std::string::npos) << message;
    };
    expectRefused("mesh", [](Scene& s) { s.objects[0].shape = BoxShape{DVec3(4)}; });
    expectRefused("lights", [](Scene& s) { s.lights.clear(); });
    expectRefused("medium", [](Scene& s) { s.materials[0].material = measured("Ketchup"); });
    expectRefused("stands elsewhere", [](Scene& s) { s.objects.pop_back(); });
    expectRefused("spacing", [](Scene& s) { s.quality.spacingMm = 0.5; });
    expectRefused("1 translucent objects, the scene has 2", [](Scene& s) {
        s.objects.push_back(s.objects[0]);
        s.objects.back().name = "second";
        s.objects.back().transform = {testing::moved({10, 0, 0})};
    });
}

// The file is whole, but what it says would send us out of bounds.
TEST(CloudCache, OctreeThatDoesNotFitIsRefused) {
    using Nodes = std::vector<OctreeNode>;
    const TemporaryFolder folder;
    const Written written(folder / "good.ssc");
    const CacheFile good = CacheFile::open(folder / "good.ssc");
    const std::function<void(Nodes&)> damages[] = {
        [](Nodes& n) { n[0].first = static_cast<std::uint32_t>(n.size()); },
        [](Nodes& n) { n[0].first = 0; },  // its own child: never ends
        [](Nodes& n) { n[0].first = 0xffffffffu; },
        [](Nodes& n) { n[0].count = 0x7fffffffu; },
        [](Nodes& n) { n.back().first = 0x7fffffffu; },
        [](Nodes& n) { n.back().count = 0xffffffffu; },
        [](Nodes& n) { n.clear(); },
        [](Nodes& n) { n[1].first = n[0].first; },  // the same children twice
        [](Nodes& n) { n.back().count -= 1; },      // a point that nobody has
        [](Nodes& n) { n[3].centroid.y = NAN; },
        [](Nodes& n) { n[3].radius = INFINITY; },
        [](Nodes& n) { n[3].centroid.y = 1e30f; },  // its distance squared would be infinite
        [](Nodes& n) { n[3].flux.z = -1; },
    };
    for (const auto& damage : damages) {
        const auto stored = good.section<OctreeNode>("octree", 0);
        Nodes nodes(stored.begin(), stored.end());
        damage(nodes);
        CacheWriter writer(folder / "bad.ssc");
        writer.add<SurfacePoint>("points", 0, {}, good.section<SurfacePoint>("points", 0));
        writer.add<Rgb>("irrad", 0, {}, good.section<Rgb>("irrad", 0));
        writer.add<OctreeNode>("octree", 0, {}, nodes);
        writer.add<NodesBefore>("before", 0, {}, good.section<NodesBefore>("before", 0));
        writer.addText("meta", 0, {}, good.text("meta", 0));
        writer.commit();
        const std::string message = refusal(folder / "bad.ssc", written.maker.scene);
        EXPECT_NE(message.find("octree of body 0 does not fit"), std::string::npos) << message;
    }
}

TEST(CloudCache, MetadataThatIsNotOursIsRefused) {
    const TemporaryFolder folder;
    const Written written(folder / "good.ssc");
    const CacheFile good = CacheFile::open(folder / "good.ssc");
    const std::pair<const char*, const char*> cases[] = {
        {"{}", "its metadata has no \"bodies\""},
        {"[]", "its metadata has no \"bodies\""},
        {R"({"bodies": 3})", "its metadata lists no bodies"},
        {R"({"bodies": [7]})", "its metadata has no \"inputs\""},
        {R"({"bodies": [{"inputs": 1}]})", "made for another scene"},
        {"not json", "bad.ssc:1:"}};
    for (const auto& [meta, words] : cases) {
        CacheWriter writer(folder / "bad.ssc");
        writer.add<SurfacePoint>("points", 0, {}, good.section<SurfacePoint>("points", 0));
        writer.addText("meta", 0, {}, meta);
        writer.commit();
        const std::string message = refusal(folder / "bad.ssc", written.maker.scene);
        EXPECT_NE(message.find(words), std::string::npos) << meta << ": " << message;
    }
}

// Sections that are whole, of a stage that is not the one they are taken for.
TEST(CloudCache, SectionsThatDoNotFitTheirPointsAreRefused) {
    const TemporaryFolder folder;
    CacheWriter writer(folder / "bad.ssc");
    writer.add<SurfacePoint>("points", 0, {}, std::vector<SurfacePoint>(3));
    writer.add<CellPiece>("pieces", 0, {}, std::vector<CellPiece>(2));
    writer.add<Vec2>("corners", 0, {}, std::vector<Vec2>(6));
    writer.add<std::uint32_t>("first", 0, {}, std::vector<std::uint32_t>{0, 1, 2});
    writer.add<SolvedExitance>("shape", 1, {}, std::vector<SolvedExitance>(2));
    writer.add<std::uint32_t>("beams", 0, {}, std::vector<std::uint32_t>(2));
    writer.commit();
    const CacheFile file = CacheFile::open(folder / "bad.ssc");
    const std::pair<std::function<void()>, const char*> readers[] = {
        {[&] { solvedOf(file, 1, 3); }, "the solution of body 1 does not fit its points"},
        {[&] { beamsOf(file, 3); }, "its beams do not fit its points"},
        {[&] { samplesOf(file, 12); }, "its cells do not fit its points"}};
    for (const auto& [read, words] : readers) {
        try {
            read();
            ADD_FAILURE() << "accepted where it should have said: " << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    }
}

TEST(CloudCache, DescribesItself) {
    const TemporaryFolder folder;
    const Written written(folder / "a.ssc");
    const JsonValue info = describeCache(folder / "a.ssc");
    EXPECT_EQ(info.find("format")->value.asNumber(), kCacheVersion);
    EXPECT_EQ(info.find("bodies")->value.items().size(), 1u);
    const JsonValue& body = info.find("bodies")->value.items()[0];
    EXPECT_EQ(body.find("points")->value.asNumber(),
              static_cast<double>(written.made.clouds[0].points.size()));
    EXPECT_EQ(body.find("meanFreePathMm")->value.items().size(), 3u);
    EXPECT_EQ(info.find("sections")->value.items().size(), 5u);
}

}  // namespace
}  // namespace sss
