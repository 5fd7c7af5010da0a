// PhotonBlocksTest.cpp - lists of photons in blocks, and the memory that they share. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/photons/PhotonBlocks.h"

#include <set>

using namespace osgRayTrace::engine;

namespace
{

/// Adds photons in groups, whose edges are consecutive numbers from first on.
void addGroups(PhotonBlocks& list, uint32_t first, uint32_t groups, uint32_t each)
{
    for (uint32_t g = 0; g < groups; ++g)
    {
        Photon* const room = list.room(16);
        for (uint32_t k = 0; k < each; ++k)
            room[k].edges = first + g * each + k;
        list.push(each);
    }
}

std::set<const Photon*> addressesOf(const PhotonBlocks& list)
{
    std::set<const Photon*> addresses;
    for (const PhotonSpan& span : list.spans())
        addresses.insert(span.begin());
    return addresses;
}

} // namespace

TEST_CASE("photon blocks: joined lists keep their order, and places find each photon", "[photons]")
{
    PhotonMemory memory;
    PhotonBlocks all(memory), empty(memory), second(memory), third(memory);
    addGroups(all, 0, 300, 7); // several blocks, none of which is full
    addGroups(second, 2100, 1, 5);
    addGroups(third, 2105, 200, 16); // full blocks
    all.append(std::move(empty));
    all.append(std::move(second));
    all.append(std::move(third));
    const PhotonSpans spans = all.spans();
    REQUIRE(all.size() == 2105 + 3200);
    CHECK(spans.size() == all.size());
    CHECK(spans.places() > spans.size());

    const std::vector<Photon> list = listOf(spans);
    REQUIRE(list.size() == all.size());
    uint32_t wrong = 0, next = 0;
    for (const Photon& photon : list)
        wrong += photon.edges != next++;
    next = 0;
    for (std::size_t s = 0; s < spans.spans(); ++s)
        for (uint32_t k = 0; k < spans.span(s).count; ++k)
            wrong += spans[s * kSpanPhotons + k].edges != next++;
    CHECK(wrong == 0);
}

TEST_CASE("photon blocks: a vector is a list whose places are its indices", "[photons]")
{
    std::vector<Photon> list(3 * kSpanPhotons + 10);
    for (uint32_t k = 0; k < list.size(); ++k)
        list[k].edges = k;
    const PhotonSpans spans = list;
    CHECK(spans.size() == list.size());
    CHECK(spans.spans() == 4);
    uint32_t wrong = 0;
    for (uint32_t k = 0; k < list.size(); ++k)
        wrong += spans[k].edges != k;
    CHECK(wrong == 0);
    CHECK(PhotonSpans(std::vector<Photon>()).spans() == 0);
}

TEST_CASE("photon blocks: the next list has the memory of the last one", "[photons]")
{
    PhotonMemory memory;
    std::set<const Photon*> first;
    {
        PhotonBlocks list(memory);
        addGroups(list, 0, 100, 16);
        PhotonBlocks other(memory);
        addGroups(other, 0, 100, 16);
        list.append(std::move(other));
        first = addressesOf(list);
        PhotonBlocks moved = std::move(list);
        CHECK(addressesOf(moved) == first);
        CHECK(memory.bytes() == 0);
    }
    CHECK(memory.bytes() == first.size() * kSpanPhotons * sizeof(Photon));
    // Whatever has been freed goes to others first.
    std::vector<PhotonMemory::Block> others;
    for (std::size_t k = 0; k < 4 * first.size(); ++k)
        others.emplace_back(new Photon[kSpanPhotons]);
    PhotonBlocks again(memory);
    addGroups(again, 0, 200, 16);
    for (const Photon* const block : addressesOf(again))
        CHECK(first.count(block) == 1);
}
