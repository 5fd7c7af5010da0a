// RayTracePlugin.h - libRayTrace.so: CalVR's objects, ray traced. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "CalVRConnections.h"
#include "PluginConfig.h"
#include "RayTraceMenu.h"
#include "TracedRoot.h"

#include <cvrKernel/CVRPlugin.h>

#include <memory>
#include <optional>

namespace osgRayTrace::calvr
{

/// Ray traces CalVR's objects, all of it on CalVR's main thread. No exception leaves the plugin. In
/// a cluster every node makes the same calls over the network, in init and once in each preFrame,
/// whether or not it traces: a node that left one out would stop all.
class RayTracePlugin : public cvr::CVRPlugin, public cvr::MenuCallback
{
public:
    RayTracePlugin() = default;
    ~RayTracePlugin() override;

    /// Returns true in any case: a node without the plugin would not make the calls of the others.
    bool init() override;
    void preFrame() override;
    void menuCallback(cvr::MenuItem* item) override;
    int getPriority() override
    {
        return -1000;
    } ///< called last: other plugins may move the objects before

private:
    void readSettings();
    void shareSettings();
    void start();
    void switchAndLight();
    void showFreeze();
    std::optional<FrameWork> offer() const;
    void agree(const std::optional<FrameWork>& offer);

    osg::ref_ptr<RayTraceSettings> _settings;
    PluginConfig _config;
    CalVRConnections _connections;
    bool _toldVersion = false; ///< true: the user was told that another node has another version
    std::optional<WorkAgreement> _agreement; ///< set in a cluster
    std::unique_ptr<TracedRoot> _root;
    std::unique_ptr<RayTraceMenu> _menu;
};

} // namespace osgRayTrace::calvr
