#pragma once
#include "sss/base/reporter.h"
#include "sss/integrate/body_optics.h"

#include <memory>
#include <span>

namespace sss {

/// How far from where it entered light leaves, in the mean, mm; what leaves beyond `reachMm` is
/// counted as leaving there. By the integral of Profile::tail() / total() over [0, reachMm].
double meanShiftMm(const Profile& profile, double reachMm);

/// mm: all but a thousandth of a body's surface is farther than this from the nearest surface of
/// the body straight below and straight above it, as far as 1024 sampled places tell. At most the
/// diagonal of its bounds.
double localThicknessMm(const World& world, int body);

/// Sets BodyOptics::inDiffuseLimit of the bodies that the scene's camera may see by their diffuse
/// limit within the tolerance, and says which these are, and why.
///
/// With s the mean shift, p the width of a pixel at the body's nearest point and t its local
/// thickness, the rule is s <= tolerance x min(p, t), and no mean free path is longer than that.
/// - What a pixel beside a straight edge of light gains or loses is s / (pi p) of the lit value:
///   half of E|x| / p, with E|x| = 2 s / pi the mean shift across the edge.
/// - The share of the light that comes out farther than t, on the other side of a thin part, is
///   at most s / t (Markov's inequality).
/// Bodies seen larger than that in a concave mirror are not looked for.
void findDiffuseLimits(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                       Reporter& reporter);

}  // namespace sss
