// FuzzSeeds.h - random numbers of a seed, and the seed's name when all else fails. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

namespace osgRayTrace::test
{

/// The same numbers on every system: the distributions of the standard library are not specified.
class Dice
{
public:
    explicit Dice(uint32_t seed) : _engine(seed) {}

    uint32_t bits() { return static_cast<uint32_t>(_engine()); }

    /// In [0, count).
    int below(int count) { return static_cast<int>(bits() % static_cast<uint32_t>(count)); }
    bool oneIn(int count) { return below(count) == 0; }

    double unit() { return bits() * 0x1p-32; }
    double between(double low, double high) { return low + (high - low) * unit(); }

    /// Mostly a number in [-size, size]; once in `rarity` something that no one should pass.
    double strange(double size, int rarity);

    template <class T, std::size_t count> T oneOf(const T (&values)[count])
    {
        return values[below(static_cast<int>(count))];
    }

private:
    std::mt19937 _engine;
};

/// Ways to damage a file.
constexpr int kDamages = 5;

/// Cuts the file off, or changes bytes or a bit of it, or takes bytes out, or puts zeros in. It is
/// not empty.
void damageBytes(std::string& file, int way, Dice& dice);

/// A sanitizer's share of the seeds: 1 without one.
int sanitizerShare();

/// Number of seeds: that of OSGRAYTRACE_FUZZ_SEEDS, else `usual`; under a sanitizer its share of
/// it, which takes about as long.
int seedCount(int usual);

/// Calls test for the seeds 0, 1, ... A seed that ends the process is named on standard error; one
/// that fails a check is named by its INFO. OSGRAYTRACE_FUZZ_FIRST is where they begin.
void forEachSeed(int usual, const std::function<void(uint32_t seed)>& test);

} // namespace osgRayTrace::test
