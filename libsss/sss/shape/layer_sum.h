#pragma once
#include "sss/cloud/kernel_table.h"
#include "sss/shape/charge_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

struct LayerCounts {
    std::uint64_t sums = 0;  ///< over all points, at all points
    std::uint64_t nodeInteractions = 0, pointInteractions = 0;
};

/// What is near and what is far of a cell of receivers.
struct LayerList {
    std::vector<std::uint32_t> nodes, points;
};

/// The single and double layer of a fluence on the boundary, at a cloud's own points x:
///   sum over y of A_y phi_y [ G(x, y) / b + dG/dn_y(x, y) ],
/// with the moments of a ChargeTree for what is far. The kernel is a table of G(r) regularised over
/// a sample's cell: finite where x = y, and its gradient, softened alike, gives dG/dn.
///
/// Error control: a node is taken whole where a bound of the third order of its expansion, seen
/// from the nearest place of the receivers' cell, is below a share of what may be missed there.
/// Const and thread-safe; the answer depends on neither threads nor order.
class LayerSum {
public:
    /// Both must outlive the sum. `perLength`: 1 / b, mm^-1.
    LayerSum(const ChargeTree& tree, const KernelTable& green, const DRgb& perLength);

    /// `out[i]`, W m^-2, at point i, to be wrong by `allowed[i]` at most; 0 sums over all points.
    void atPoints(std::span<const Rgb> allowed, std::span<DRgb> out, LayerCounts& counts) const;
    /// The sum over all points by the same table: the oracle.
    DRgb bruteForce(const Vec3& receiver) const;

private:
    void collect(std::size_t cell, const Rgb& allowed, LayerList& list,
                 std::vector<std::uint32_t>& stack) const;

    const ChargeTree& tree_;
    const KernelTable& green_;
    Rgb perLength_;
    std::vector<std::uint32_t> cells_;  ///< nodes whose points are evaluated together
};

/// A cell's receivers at most.
inline constexpr std::size_t kMostLayerReceivers = 32;
/// Adds the layers of a list's nodes and points at up to kMostLayerReceivers places; chosen at run
/// time for the processor.
void accumulateLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                      const Rgb& perLength, std::span<const Vec3> receivers, std::span<DRgb> sums);
/// The same in plain C++: the reference that the vector code is tested against.
void accumulateLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                            const Rgb& perLength, std::span<const Vec3> receivers,
                            std::span<DRgb> sums);

}  // namespace sss
