// StandIn.h - stands in for Open Image Denoise in tests: checks how it is called, and denoises with
// a mean of 3 x 3 pixels.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::engine::test
{

/// The call that fails, as the library reports it: by an error that is asked for later.
enum class Fault
{
    None,
    NewDevice, ///< returns null
    CommitDevice,
    NewFilter, ///< returns null
    CommitFilter,
    Execute,
};

/// The requests to the library since beginStandIn(). It may be used by one thread.
struct StandIn
{
    Fault fault = Fault::None;

    std::vector<std::string> calls;    ///< that make something: "device 2 threads", "commit 8x6"
    std::vector<std::string> mistakes; ///< requests that the library does not allow
    int devices = 0, filters = 0;      ///< not yet released
    std::vector<float> light, albedo, normal; ///< inputs of the last execution

    int times(const std::string& call) const;
};

/// Returns the only stand-in.
StandIn& standIn();

/// Forgets everything but devices and filters, and returns the stand-in.
StandIn& beginStandIn(Fault fault = Fault::None);

} // namespace osgRayTrace::engine::test
