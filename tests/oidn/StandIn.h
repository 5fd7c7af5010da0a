// StandIn.h - stands in for Open Image Denoise in tests: checks how it is called, and denoises with
// a mean of 3 x 3 pixels.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::engine::test
{

/// A call that fails, as the library says it: by an error that is asked for later.
enum class Fault
{
    None,
    NewDevice, ///< returns null
    CommitDevice,
    NewFilter, ///< returns null
    CommitFilter,
    Execute,
};

/// What the library was asked for since begin(). One thread.
struct StandIn
{
    Fault fault = Fault::None;

    std::vector<std::string> calls; ///< that make something of it: "device 2 threads", "commit 8x6"
    std::vector<std::string> mistakes;        ///< what it must not be asked for
    int devices = 0, filters = 0;             ///< that are not released
    std::vector<float> light, albedo, normal; ///< of the last execution, as they came in

    int times(const std::string& call) const;
};

/// The one there is.
StandIn& standIn();

/// All forgotten but devices and filters.
StandIn& beginStandIn(Fault fault = Fault::None);

} // namespace osgRayTrace::engine::test
