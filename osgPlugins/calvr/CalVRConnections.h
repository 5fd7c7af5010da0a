// CalVRConnections.h - the connections of CalVR's cluster. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "Cluster.h"

namespace osgRayTrace::calvr
{

class CalVRConnections : public Connections
{
public:
    bool isMaster() const override;
    int slaveCount() const override;
    bool sendToMaster(const void* data, int bytes) override;
    bool readFromSlaves(void* data, int bytesOfEach) override;
    bool sendToSlaves(const void* data, int bytes) override;
    bool readFromMaster(void* data, int bytes) override;
};

} // namespace osgRayTrace::calvr
