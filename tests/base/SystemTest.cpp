// SystemTest.cpp - what compilers, processors and systems do in ways of their own. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Bits.h"
#include "osgRayTrace/base/Cpu.h"
#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/base/Platform.h"
#include "tests/Catch.h"

#include <cstring>
#include <string>

#define TEXT_OF_TOKENS(...) #__VA_ARGS__
#define TEXT_OF(...) TEXT_OF_TOKENS(__VA_ARGS__)

using namespace osgRayTrace::engine;

namespace
{

/// Returns the part of the square of x that a float cannot hold, if the kernel has fused
/// multiplication and addition, else 0.
OSGRAYTRACE_KERNEL
void squareLess(const float* __restrict x, const float* __restrict y, float* __restrict out)
{
    for (int i = 0; i < 16; ++i)
        out[i] = x[i] * x[i] - y[i];
}

bool isLevel(const char* level)
{
    return std::strcmp(cpuLevel(), level) == 0;
}

} // namespace

TEST_CASE("Kernel: the version for the processor at hand runs", "[base]")
{
    float x[16], y[16], out[16];
    for (int i = 0; i < 16; ++i)
    {
        x[i] = 1.0f + 0x1p-12f;
        y[i] = 1.0f + 0x1p-11f;
    }
    squareLess(x, y, out);
    // AVX-512 has fused operations; a version for AVX2 alone, without the rest of its level, has
    // not.
    const std::string versions = TEXT_OF(OSGRAYTRACE_KERNEL);
    const bool one = versions.empty(), levels = versions.find("x86-64-v3") != std::string::npos;
    const bool fused = isLevel("x86-64-v4") || (isLevel("x86-64-v3") && levels);
    for (const float value : out)
    {
        if (one)
            CHECK((value == 0.0f || value == 0x1p-24f));
        else
            CHECK(value == (fused ? 0x1p-24f : 0.0f));
    }
}

TEST_CASE("Bits: as counted one by one", "[base]")
{
    for (const uint32_t mask :
         {1u, 2u, 0x80000000u, 0xffffu, 0xffffffffu, 0x00f0a010u, 0x12345678u})
    {
        int lowest = 0, count = 0;
        while (!((mask >> lowest) & 1u))
            ++lowest;
        for (int bit = 0; bit < 32; ++bit)
            count += static_cast<int>((mask >> bit) & 1u);
        CHECK(lowestBit(mask) == lowest);
        CHECK(countBits(mask) == count);
    }
    CHECK(countBits(0) == 0);
}

TEST_CASE("FlushDenormals: for its lifetime", "[base]")
{
    volatile float small = 0x1p-126f;
    const auto half = [&] { return small * 0.5f; };
    CHECK(half() != 0.0f);
    const bool known = isLevel("aarch64") || !isLevel("other");
    {
        const FlushDenormals flush;
        CHECK((half() == 0.0f) == known);
        {
            const FlushDenormals again;
        }
        CHECK((half() == 0.0f) == known);
    }
    CHECK(half() != 0.0f);
}

TEST_CASE("Platform: aligned memory, and the program's own path", "[base]")
{
    for (const std::size_t alignment : {std::size_t(64), std::size_t(1) << 21})
    {
        void* const memory = allocateAligned(alignment, 2 * alignment);
        REQUIRE(memory != nullptr);
        CHECK(reinterpret_cast<std::uintptr_t>(memory) % alignment == 0);
        preferHugePages(memory, 2 * alignment);
        std::memset(memory, 1, 2 * alignment);
        freeAligned(memory);
    }
    CHECK(programPath().stem() == "baseTest");
}
