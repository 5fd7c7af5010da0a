// PluginConfig.h - the plugin's element in CalVR's configuration as settings. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::calvr
{

/// Holds the parts of the configuration that are none of our options.
struct PluginConfig
{
    bool trace = true;              ///< element Trace; true: ray traced from the first frame on
    double clusterBudget = 33.0;    ///< element ClusterBudget: time for all views of a node in a
                                    ///< frame, if nodes agree [ms]
    std::vector<std::string> given; ///< options in the configuration, as it spells them
    std::vector<std::string> complaints; ///< one sentence each
};

/// Returns settings with the defaults of CalVR's walls, which take the same passes and resolution.
/// Values of the environment hold.
osg::ref_ptr<RayTraceSettings> wallSettings();

/// Reads the children of <Plugin><RayTrace>, <LightSamples value="16"/>: Trace, ClusterBudget, and
/// every option by its name in any spelling. names: names of the elements; valueOf: returns the
/// value of one. An element that is none of these, or has a value that its option does not take,
/// changes nothing and adds a complaint.
PluginConfig readConfig(const std::vector<std::string>& names,
                        const std::function<std::string(const std::string& name)>& valueOf,
                        RayTraceSettings& settings);

/// Returns all that the nodes of a cluster must have in common, as lines "option=value". The number
/// of threads and the time that a node has are left out. "trace" is included, for a click in the
/// menu switches every node to the opposite state.
std::string sharedSettings(const RayTraceSettings& settings, const PluginConfig& config);

/// Sets the options of such lines. Lines that fit no option are left out (the other node has
/// another version of us) and returned, as sentences.
std::vector<std::string> takeSharedSettings(const std::string& lines, RayTraceSettings& settings,
                                            PluginConfig& config);

/// Sets what nodes need to show one picture. photon-guiding is off: without it pass k has the same
/// photons on all nodes, for its random numbers depend on seed and k alone. Views are frame-locked
/// and take the passes that all of them agree on, in the node's ClusterBudget. Returns one sentence
/// that names what the configuration or the environment wanted otherwise; empty: nothing.
std::string makeEqualOnAllNodes(RayTraceSettings& settings, const PluginConfig& config);

} // namespace osgRayTrace::calvr
