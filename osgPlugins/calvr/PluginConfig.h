// PluginConfig.h - the plugin's element in CalVR's configuration as settings. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::calvr
{

/// What the configuration says that is none of our options.
struct PluginConfig
{
    bool trace = true; ///< Trace: ray traced from the first frame on
    double clusterBudget =
        33.0; ///< ClusterBudget: tracing of all views of a node in a frame, if nodes agree [ms]
    std::vector<std::string> given;      ///< options that the configuration has, as it spells them
    std::vector<std::string> complaints; ///< one sentence each
};

/// Settings with the defaults of CalVR's walls: these take the same passes and resolution. What the
/// environment says holds.
osg::ref_ptr<RayTraceSettings> wallSettings();

/// Reads the children of <Plugin><RayTrace>, <LightSamples value="16"/>: Trace, ClusterBudget, and
/// every option by its name in any spelling. names: of the elements there are; valueOf: the value
/// of one. What is none of these, or has a value that its option does not take, changes nothing and
/// is complained of.
PluginConfig readConfig(const std::vector<std::string>& names,
                        const std::function<std::string(const std::string& name)>& valueOf,
                        RayTraceSettings& settings);

/// All that the nodes of a cluster must have in common, as lines "option=value": all but the number
/// of threads and the time that a node has, and "trace", for a click in the menu switches every
/// node to what it was not.
std::string sharedSettings(const RayTraceSettings& settings, const PluginConfig& config);

/// Takes such lines over; what fits no option is left out (another version of us on that node) and
/// returned, as sentences.
std::vector<std::string> takeSharedSettings(const std::string& lines, RayTraceSettings& settings,
                                            PluginConfig& config);

/// Sets what nodes need to show one picture. photon-guiding is off: without it pass k has the same
/// photons on all nodes, for its random numbers depend on seed and k alone. Views are frame-locked
/// and take what all of them agree on, in the node's ClusterBudget. Returns one sentence that names
/// what the configuration or the environment wanted otherwise; empty: nothing.
std::string makeEqualOnAllNodes(RayTraceSettings& settings, const PluginConfig& config);

} // namespace osgRayTrace::calvr
