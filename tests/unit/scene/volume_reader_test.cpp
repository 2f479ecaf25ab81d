#include "unit/scene/scene_text.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(VolumeReader, ReadsEveryVolume) {
    const Scene scene = read({.units = "0.01", .rest = R"(, "volumes": [
        {"name": "fog", "shape": "box", "size": [1, 2, 3], "sigmaSPerMm": [0.1, 0.2, 0.3],
         "sigmaAPerMm": 0.5, "g": -0.4, "transform": [{"translate": [0, 4, 0]}]},
        {"shape": "sphere", "radius": 2, "sigmaAPerMm": 1, "emission": [7, 8, 9],
         "grid": {"file": "flame.raw", "dimensions": [2, 3, 4], "channels": 4}},
        {"mesh": "cow.ply", "sigmaSPerMm": 1},
        {"shape": "cylinder", "radius": 1, "height": 2, "sigmaAPerMm": 1}])"});
    ASSERT_EQ(scene.volumes.size(), 4u);
    const VolumeSettings& fog = scene.volumes[0];
    EXPECT_EQ(fog.name, "fog");
    EXPECT_EQ(std::get<BoxShape>(fog.shape).sizeMm, DVec3(10, 20, 30));
    EXPECT_EQ(fog.sigmaS, Rgb(0.1f, 0.2f, 0.3f));  // mm^-1 whatever the unit
    EXPECT_EQ(fog.sigmaA, Rgb(0.5f));
    EXPECT_EQ(fog.g, -0.4);
    EXPECT_EQ(fog.emission, Rgb(0));
    EXPECT_FALSE(fog.grid.has_value());
    EXPECT_EQ(std::get<DMat4>(fog.transform.at(0))[3].y, 40);
    const VolumeSettings& flame = scene.volumes[1];
    EXPECT_EQ(flame.name, "\"volumes\"[1]");
    EXPECT_EQ(flame.emission, Rgb(7, 8, 9));
    ASSERT_TRUE(flame.grid.has_value());
    EXPECT_EQ(flame.grid->path, "/scenes/here/flame.raw");
    EXPECT_EQ(flame.grid->nx, 2);
    EXPECT_EQ(flame.grid->ny, 3);
    EXPECT_EQ(flame.grid->nz, 4);
    EXPECT_EQ(flame.grid->channels, 4);
    EXPECT_EQ(std::get<MeshFileShape>(scene.volumes[2].shape).path, "/scenes/here/cow.ply");
    EXPECT_EQ(std::get<CylinderShape>(scene.volumes[3].shape).heightMm, 20);
    EXPECT_TRUE(read({}).volumes.empty());
}

}  // namespace
}  // namespace sss
