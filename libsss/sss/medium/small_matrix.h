#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sss {

/// A dense square matrix of some tens of rows.
class SmallMatrix {
public:
    explicit SmallMatrix(std::size_t size) : size_(size), values_(size * size, 0.0) {}
    static SmallMatrix identity(std::size_t size) {
        SmallMatrix m(size);
        for (std::size_t i = 0; i < size; ++i) m(i, i) = 1;
        return m;
    }
    std::size_t size() const { return size_; }
    double& operator()(std::size_t row, std::size_t column) {
        return values_[row * size_ + column];
    }
    double operator()(std::size_t row, std::size_t column) const {
        return values_[row * size_ + column];
    }
    double largest() const {
        double most = 0;
        for (const double value : values_) most = std::max(most, std::abs(value));
        return most;
    }
    SmallMatrix& operator+=(const SmallMatrix& other) {
        for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
        return *this;
    }
    friend SmallMatrix operator*(const SmallMatrix& a, const SmallMatrix& b) {
        SmallMatrix product(a.size_);
        for (std::size_t i = 0; i < a.size_; ++i) {
            for (std::size_t k = 0; k < a.size_; ++k) {
                const double factor = a(i, k);
                for (std::size_t j = 0; j < a.size_; ++j) product(i, j) += factor * b(k, j);
            }
        }
        return product;
    }

    /// (I - a)^-1 b by elimination with row pivots.
    static SmallMatrix solveIdentityMinus(const SmallMatrix& a, SmallMatrix b) {
        const std::size_t n = a.size_;
        SmallMatrix m = identity(n);
        for (std::size_t i = 0; i < m.values_.size(); ++i) m.values_[i] -= a.values_[i];
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k + 1; i < n; ++i) {
                if (std::abs(m(i, k)) > std::abs(m(pivot, k))) pivot = i;
            }
            for (std::size_t j = 0; j < n; ++j) {
                std::swap(m(k, j), m(pivot, j));
                std::swap(b(k, j), b(pivot, j));
            }
            for (std::size_t i = 0; i < n; ++i) {
                if (i == k) continue;
                const double factor = m(i, k) / m(k, k);
                if (factor == 0) continue;
                for (std::size_t j = k; j < n; ++j) m(i, j) -= factor * m(k, j);
                for (std::size_t j = 0; j < n; ++j) b(i, j) -= factor * b(k, j);
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) b(i, j) /= m(i, i);
        }
        return b;
    }

private:
    std::size_t size_;
    std::vector<double> values_;
};

}  // namespace sss
