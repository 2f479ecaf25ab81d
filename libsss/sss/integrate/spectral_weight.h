#pragma once
#include "sss/integrate/medium_coefficients.h"

namespace sss {

/// The weight of a path whose every choice is made by one channel, the hero, picked evenly at its
/// start: the contribution of each channel over the mean of the densities with which the three
/// would have made the same path (the balance heuristic over whole paths [Wilkie et al. 2014, "Hero
/// Wavelength Spectral Sampling", Eq. 7]). No channel's weight exceeds three times what it would be
/// if that channel alone had led.
class SpectralWeight {
public:
    explicit SpectralWeight(int hero) : hero_(hero) {}

    int hero() const { return hero_; }
    Rgb value() const { return contribution_ * (3.0f / (density_.x + density_.y + density_.z)); }

    /// By a factor that no channel chose, or that all chose alike.
    void scale(const Rgb& factor) { contribution_ *= factor; }
    void scale(float factor) { contribution_ *= factor; }
    /// By a choice: what each channel contributes, and with which density it would have chosen so.
    void choose(const Rgb& contribution, const Rgb& density) {
        const Rgb relative = density / density[hero_];
        contribution_ *= contribution / density[hero_];
        density_ *= relative;
        // Only ratios count; long paths would leave the range of float.
        const float largest = maxComponent(density_);
        contribution_ /= largest;
        density_ /= largest;
    }

private:
    int hero_;
    Rgb contribution_{1.0f}, density_{1.0f};
};

/// Distance to the next collision, mm, sampled by the hero's extinction; infinite in vacuum.
float sampleFreePath(const MediumCoefficients& medium, int hero, float u);
/// The path went this far without a collision.
void passThrough(const MediumCoefficients& medium, float distanceMm, SpectralWeight& weight);
/// It went this far and was scattered there.
void collide(const MediumCoefficients& medium, float distanceMm, SpectralWeight& weight);
/// A direction scattered from `along`, by the hero's phase function.
Vec3 scatter(const MediumCoefficients& medium, const Vec3& along, const Vec2& u,
             SpectralWeight& weight);

}  // namespace sss
