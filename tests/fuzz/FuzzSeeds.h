// FuzzSeeds.h - random numbers of a seed, and the seed's name if the process dies. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

namespace osgRayTrace::test
{

/// Gives the same numbers on every system, because the distributions of the standard library are
/// not specified.
class Dice
{
public:
    explicit Dice(uint32_t seed) : _engine(seed) {}

    uint32_t bits() { return static_cast<uint32_t>(_engine()); }

    /// Returns a number in [0, count).
    int below(int count) { return static_cast<int>(bits() % static_cast<uint32_t>(count)); }
    bool oneIn(int count) { return below(count) == 0; }

    double unit() { return bits() * 0x1p-32; }
    double between(double low, double high) { return low + (high - low) * unit(); }

    /// Returns in most cases a number in [-size, size], but once in `rarity` cases a value that no
    /// caller should pass.
    double strange(double size, int rarity);

    template <class T, std::size_t count> T oneOf(const T (&values)[count])
    {
        return values[below(static_cast<int>(count))];
    }

private:
    std::mt19937 _engine;
};

/// There are this many ways to damage a file.
constexpr int kDamages = 5;

/// Cuts the file off, changes bytes or one bit of it, removes bytes, or puts zeros in. The file
/// must not be empty.
void damageBytes(std::string& file, int way, Dice& dice);

/// Returns by what the number of seeds is divided under a sanitizer; 1 without one.
int sanitizerShare();

/// Returns the number of seeds: OSGRAYTRACE_FUZZ_SEEDS if it is set, else `usual`, which is divided
/// by sanitizerShare() so that it takes about as long.
int seedCount(int usual);

/// Calls test for the seeds 0, 1, ..., or from OSGRAYTRACE_FUZZ_FIRST on. A seed that ends the
/// process is named on standard error; one that fails a check is named by its INFO.
void forEachSeed(int usual, const std::function<void(uint32_t seed)>& test);

} // namespace osgRayTrace::test
