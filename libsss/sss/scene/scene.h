#pragma once
#include "sss/base/vec.h"
#include "sss/image/filter.h"
#include "sss/medium/energy.h"
#include "sss/medium/medium.h"
#include "sss/medium/profile.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

// A scene as its author wrote it, checked and in our units (mm, mm^-1, radian unless the name says
// degrees), before any file but the scene itself has been opened. Plain data; scene_reader.h fills
// it and scenes/README.md documents every key.
namespace sss {

struct CameraSettings {
    DVec3 position{0, 0, 100};
    DVec3 lookAt{0, 0, 0};
    DVec3 up{0, 1, 0};
    double fovDegrees = 40;       ///< vertical, in (0, 180)
    double apertureRadiusMm = 0;  ///< 0 = pinhole
    double focusDistanceMm = 0;   ///< 0 = distance to lookAt
};

struct FilmSettings {
    int width = 512, height = 512;
    int samples = 64;  ///< per pixel
    FilterKind filter = FilterKind::BlackmanHarris;
    double filterRadiusPixels = 0;    ///< 0 = the filter's own default (box 0.5)
    std::vector<std::string> layers;  ///< beside beauty: diffusion single surface albedo N Z
    double exposureStops = 0;         ///< of the PNG only
    bool halfPrecision = true;        ///< colour layers of the EXR
};

/// Multiple-scattering medium behind a dielectric boundary.
struct TranslucentMaterial {
    Medium medium;
    std::string mediumName;  ///< measured name, or empty
    std::string profile = "dipole";
    ProfileOptions profileOptions;
    EnergyConvention energy = EnergyConvention::Consistent;
    std::optional<DRgb> diffuseColor;  ///< if the medium was made from one: the total it shows
    double roughness = 0;              ///< of the boundary; GGX alpha = roughness^2; 0 = smooth
    bool surfaceReflection = true;
    bool singleScattering = true;
    bool multipleScattering = true;
    /// Diffusion solved on the body's own shape (closed bodies only) instead of the profile alone.
    bool onShape = false;
};
struct LambertianMaterial {
    Rgb reflectance{0.5f};
};
/// Cook-Torrance conductor: GGX distribution, Smith shadowing, exact conductor Fresnel.
struct MetalMaterial {
    Rgb eta{0.2f, 0.92f, 1.1f};
    Rgb k{3.9f, 2.45f, 2.14f};
    double roughness = 0.2;  ///< GGX alpha = roughness^2
};
struct EmitterMaterial {
    Rgb radiance{1.0f};  ///< W m^-2 sr^-1
    bool twoSided = false;
};
using Material =
    std::variant<TranslucentMaterial, LambertianMaterial, MetalMaterial, EmitterMaterial>;
struct NamedMaterial {
    std::string name;
    Material material;
    double spacingMm = 0;  ///< of points on bodies of it; 0 = from tolerance and mean free path
};

struct MeshFileShape {
    std::filesystem::path path;  ///< absolute, or relative to the scene file (resolved)
};
struct SphereShape {
    double radiusMm = 1;
};
struct RectangleShape {  ///< in x and y, facing +z, centred
    double widthMm = 1, heightMm = 1;
};
struct DiskShape {  ///< in x and y, facing +z, centred
    double radiusMm = 1;
};
struct BoxShape {  ///< centred
    DVec3 sizeMm{1};
};
struct CylinderShape {  ///< along y, centred, capped
    double radiusMm = 1, heightMm = 1;
};
using Shape =
    std::variant<MeshFileShape, SphereShape, RectangleShape, DiskShape, BoxShape, CylinderShape>;

/// Scales and moves an object so that its bounding box has this height (y) and this centre.
struct FitStep {
    double heightMm = 1;
    DVec3 centre{0};
};
/// One step of an object's transform, applied in the order written: an affine, invertible matrix
/// (lengths in mm; a negative determinant mirrors, which turns the winding of faces), or a
/// fit that depends on the bounds of the mesh as transformed so far.
using TransformStep = std::variant<DMat4, FitStep>;

enum class NormalsMode {
    Auto,    ///< the file's, or smooth with a crease at 40 degrees; shapes bring their own
    Smooth,  ///< angle-weighted over all faces of a vertex
    Flat,
};

struct ObjectSettings {
    std::string name;
    Shape shape;
    std::vector<TransformStep> transform;
    int material = 0;   ///< index into Scene::materials
    std::string group;  ///< objects of one group are one body; empty = own body
    NormalsMode normals = NormalsMode::Auto;
    int line = 0, column = 0;  ///< where the object stands in the scene file
};

struct PointLight {
    DVec3 position{0};
    Rgb intensity{1.0f};  ///< W sr^-1
};
struct SpotLight {
    DVec3 position{0};
    DVec3 lookAt{0};
    Rgb intensity{1.0f};         ///< W sr^-1 on the axis
    double coneDegrees = 30;     ///< half angle where the light ends
    double penumbraDegrees = 5;  ///< width of the soft edge inside the cone
};
struct DirectionalLight {
    DVec3 direction{0, -1, 0};  ///< the way the light travels
    Rgb irradiance{1.0f};       ///< W m^-2 on a facing surface
};
struct RectangleLight {
    DVec3 centre{0};
    DVec3 lookAt{0};  ///< it faces this point
    DVec3 up{0, 1, 0};
    double widthMm = 1, heightMm = 1;
    Rgb radiance{1.0f};  ///< W m^-2 sr^-1
    bool twoSided = false;
};
struct SphereLight {
    DVec3 centre{0};
    double radiusMm = 1;
    Rgb radiance{1.0f};
};
struct EnvironmentLight {
    Rgb radiance{1.0f};          ///< scales the map if there is one
    std::filesystem::path map;   ///< lat-long EXR; empty = constant
    double rotationDegrees = 0;  ///< about +y
};
using LightSettings = std::variant<PointLight, SpotLight, DirectionalLight, RectangleLight,
                                   SphereLight, EnvironmentLight>;

/// Values at the nodes of a regular lattice over the bounding box of a volume's shape, the
/// outermost nodes on its faces, x fastest; little-endian floats in a file without a header.
struct GridFile {
    std::filesystem::path path;  ///< absolute, or relative to the scene file (resolved)
    int nx = 2, ny = 2, nz = 2;  ///< nodes along the axes of the shape, each 2 or more
    /// 1: the density. 4: the density, and three factors of the emission.
    int channels = 1;
};
/// A participating medium in space: around things, or a thing of its own. It has no boundary that
/// light would notice.
struct VolumeSettings {
    std::string name;
    Shape shape;  ///< closed
    std::vector<TransformStep> transform;
    Rgb sigmaA{0.0f}, sigmaS{0.0f};  ///< mm^-1, where the density is 1
    double g = 0;                    ///< mean cosine of scattering, Henyey-Greenstein
    Rgb emission{0.0f};  ///< L_e, W m^-2 sr^-1: sigmaA L_e is emitted along each mm, where 1
    std::optional<GridFile> grid;  ///< none: the density is 1 everywhere
    int line = 0, column = 0;      ///< where the volume stands in the scene file
};

struct QualitySettings {
    double tolerance = 0.01;    ///< relative error asked of diffusion, (0, 0.5]
    double spacingMm = 0;       ///< 0 = from tolerance and mean free path
    int irradianceSamples = 0;  ///< per point and light; 0 = from tolerance
    int bounces = 4;            ///< indirect bounces between objects; 0 = direct light only
    std::uint64_t seed = 0;
    std::uint64_t cameraSeed = 0;                  ///< of the camera's noise, beside `seed`
    std::string integrator = "cached";             ///< a row of integrate/integrator_table.h
    int integratorLine = 0, integratorColumn = 0;  ///< where the file names it; 0 = it does not
};

struct Scene {
    std::filesystem::path file;
    double metersPerUnit = 0.001;  ///< what the file said; everything here is already mm
    int frame = 1;                 ///< of an animation
    int referenceFrame = 1;        ///< in whose shape points are placed on what deforms
    CameraSettings camera;
    FilmSettings film;
    QualitySettings quality;
    std::vector<NamedMaterial> materials;
    std::vector<ObjectSettings> objects;
    std::vector<LightSettings> lights;
    std::vector<VolumeSettings> volumes;
};

}  // namespace sss
