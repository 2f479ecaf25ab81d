#pragma once
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/local_expansion.h"
#include "sss/shape/charge_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

struct LayerCounts {
    std::uint64_t sums = 0;               ///< over all points, at all points
    std::uint64_t localInteractions = 0;  ///< cell of receivers x node
    std::uint64_t nodeInteractions = 0;   ///< receiver x node
    std::uint64_t pointInteractions = 0;  ///< receiver x point

    void add(const LayerCounts& other);
    std::uint64_t interactions() const {
        return localInteractions + nodeInteractions + pointInteractions;
    }
};

/// What a cell of receivers takes: nodes for the whole cell at once, nodes receiver by receiver,
/// and points.
struct LayerList {
    std::vector<std::uint32_t> locals, nodes, points;
};

/// The single and double layer of a fluence on the boundary, at a cloud's own points x:
///   sum over y of A_y phi_y [ G(x, y) / b + dG/dn_y(x, y) ],
/// with the moments of a ChargeTree for what is far. The kernel is a table of G(r) regularised over
/// a sample's cell: finite where x = y, and its gradient, softened alike, gives dG/dn.
///
/// The octree is both: its nodes are sources and cells of receivers. What is far from a cell is
/// added once for all its receivers, as a polynomial of second order (LocalExpansion); what is
/// nearer is left to the cell's children; small cells take nodes, and at last points, receiver by
/// receiver.
///
/// Error control: a node is taken whole where a bound of the third order of its expansion, seen
/// from the nearest place of the receivers' cell, is below a share of what may be missed there.
/// Const and thread-safe; the answer depends on neither threads nor order.
class LayerSum {
public:
    /// Both must outlive the sum. `perLength`: 1 / b, mm^-1, the largest of any point.
    LayerSum(const ChargeTree& tree, const KernelTable& green, const DRgb& perLength);

    /// `out[i]`, W m^-2, at point i, to be wrong by `allowed[i]` at most; 0 sums over all points.
    void atPoints(std::span<const Rgb> allowed, std::span<DRgb> out, LayerCounts& counts) const;
    /// The sum over all points by the same table: the oracle.
    DRgb bruteForce(const Vec3& receiver) const;

private:
    struct Walk;  // of one thread
    bool isSmall(std::size_t node) const;
    std::vector<Rgb> leastBelow(std::span<const Rgb> allowed) const;
    /// Adds what `left` and all below it bring to a cell, on top of what its parents took.
    void descend(std::size_t cell, const LocalExpansion& above, std::span<const std::uint32_t> left,
                 Walk& walk) const;
    void finish(std::size_t cell, const LocalExpansion& far, Walk& walk) const;

    const ChargeTree& tree_;
    const KernelTable& green_;
    Rgb perLength_;
    std::vector<std::uint32_t> groups_;  ///< nodes whose points are evaluated together
};

/// A cell's receivers at most.
inline constexpr std::size_t kMostLayerReceivers = 24;
/// Adds a list's nodes and points at up to kMostLayerReceivers places; chosen at run
/// time for the processor.
void accumulateLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                      std::span<const Vec3> receivers, std::span<DRgb> sums);
/// Adds what a list's locals bring around the centre of an expansion.
void expandLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                  LocalExpansion& expansion);
/// The same in plain C++: the references that the vector code is tested against.
void expandLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                        LocalExpansion& expansion);
void accumulateLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                            std::span<const Vec3> receivers, std::span<DRgb> sums);

}  // namespace sss
