// FuzzSeeds.cpp - random numbers of a seed, and the seed's name if the process dies. Layer: tests.
// SPDX-License-Identifier: MIT
#include "FuzzSeeds.h"

#include "tests/Catch.h"

#include <cstdio>
#include <cstdlib>
#include <limits>

#if defined(__SANITIZE_ADDRESS__)
extern "C" void __sanitizer_set_death_callback(void (*callback)());
#endif

namespace osgRayTrace::test
{

namespace
{

volatile uint32_t t_seed = 0; // of this process's only test thread; read when the process dies

#if defined(__SANITIZE_ADDRESS__)
void nameSeed()
{
    std::fprintf(stderr, "the failing seed is %u\n", static_cast<unsigned>(t_seed));
}
#endif

int numberFrom(const char* variable, int otherwise)
{
    const char* text = std::getenv(variable);
    const int number = text ? std::atoi(text) : 0;
    return number > 0 ? number : otherwise;
}

} // namespace

double Dice::strange(double size, int rarity)
{
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    constexpr double kStrange[] = {std::numeric_limits<double>::quiet_NaN(),
                                   kInfinite,
                                   -kInfinite,
                                   0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   1e-45,
                                   1e-38,
                                   1e-30,
                                   1e-12,
                                   1e6,
                                   -1e6,
                                   1e12,
                                   1e17,
                                   1e18,
                                   1.9e18,
                                   -1e19,
                                   1e30,
                                   3.4e38,
                                   -3.4e38,
                                   1e300};
    if (!oneIn(rarity)) return between(-size, size);
    return oneOf(kStrange);
}

void damageBytes(std::string& file, int way, Dice& dice)
{
    const auto place = [&]
    { return static_cast<std::size_t>(dice.below(static_cast<int>(file.size()))); };
    switch (way)
    {
    case 0:
        file.resize(place());
        return;
    case 1:
        for (int i = 1 + dice.below(16); i > 0; --i)
            file[place()] = static_cast<char>(dice.bits());
        return;
    case 2:
        file[place()] ^= static_cast<char>(1 << dice.below(8));
        return;
    case 3:
        file.erase(place(), static_cast<std::size_t>(1 + dice.below(20)));
        return;
    default:
        file.insert(place(), std::string(static_cast<std::size_t>(1 + dice.below(20)), '\0'));
    }
}

int sanitizerShare()
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return 8;
#else
    return 1;
#endif
}

int seedCount(int usual)
{
    const int share = sanitizerShare();
    return numberFrom("OSGRAYTRACE_FUZZ_SEEDS", (usual + share - 1) / share);
}

void forEachSeed(int usual, const std::function<void(uint32_t seed)>& test)
{
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_set_death_callback(nameSeed);
#endif
    const auto first = static_cast<uint32_t>(numberFrom("OSGRAYTRACE_FUZZ_FIRST", 0));
    const auto count = static_cast<uint32_t>(seedCount(usual));
    for (uint32_t seed = first; seed < first + count; ++seed)
    {
        t_seed = seed;
        INFO("the failing seed is " << seed);
        test(seed);
    }
}

} // namespace osgRayTrace::test
