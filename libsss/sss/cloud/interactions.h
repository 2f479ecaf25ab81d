#pragma once
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Sources that a group of receivers sums over, laid out for straight vector loops: single points,
/// or nodes with their second moments.
class InteractionList {
public:
    static constexpr std::size_t kBlock = 64;
    /// Padded with dark sources to a multiple of kPad.
    static constexpr std::size_t kPad = 16;
    struct alignas(64) Block {
        float x[kBlock], y[kBlock], z[kBlock];
        float moments[6][kBlock];  ///< xx yy zz xy xz yz; untouched in a list of points
        float flux[kBlock][4];
        /// OctreeNode::lean by axis, source and channel, and each source's mean flux: untouched
        /// unless the block is coloured, that is, has sources whose channels lie apart.
        float lean[3][kBlock][4];
        float meanFlux[kBlock];
        std::size_t count = 0;
        bool isColoured = false;
    };

    void clear() { used_ = 0; }
    /// Those of the points that are not dark; says how many are.
    std::size_t addPoints(std::span<const SurfacePoint> points, std::span<const Rgb> irradiance);
    /// Makes this the list of the nodes with these indices.
    void setNodes(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices);
    std::span<const Block> blocks() const { return std::span(blocks_).first(used_); }
    std::size_t size() const;
    /// Fills the last vector up.
    void pad();

private:
    Block& room();
    std::vector<Block> blocks_;
    std::size_t used_ = 0;
};

/// Writes the nodes with these indices, at most a block, to the beginning of a block.
void pack(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
          InteractionList::Block& to);
/// The same in plain C++: the reference that the vector code is tested against.
void packScalar(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
                InteractionList::Block& to);

/// Of a source of a coloured block.
Vec3 leanOf(const InteractionList::Block& block, std::size_t i, int channel);
/// d^T Q d of source i.
float quadraticForm(const InteractionList::Block& block, std::size_t i, const Vec3& d);

/// What packScalar() does about colour where there is any: `to` has its leans from these nodes.
void packLeans(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
               InteractionList::Block& to);

/// Adds to sums[i] the sum over the list of flux x f(|receiver - source|^2), where `withMoments`
/// with the terms of first and second order of each node: f + f' tr Q + 2 f'' d^T Q d, primes by u
/// = r^2, and for channels that lie elsewhere - 2 f' d lean x mean flux. Highway picks the widest
/// instructions of the machine at run time. Within a block of 64 sums are float, over blocks
/// double.
void accumulate(const KernelTable& table, const InteractionList& list, bool withMoments,
                std::span<const Vec3> receivers, std::span<DRgb> sums);
/// The same in plain C++: the reference that the vector code is tested against.
void accumulateScalar(const KernelTable& table, const InteractionList& list, bool withMoments,
                      std::span<const Vec3> receivers, std::span<DRgb> sums);
/// Name of the instruction set that accumulate uses here, for statistics.
const char* accumulateTarget();

}  // namespace sss
