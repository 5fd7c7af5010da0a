// CalVRConnections.cpp - calls of ComController, whose send functions lack const. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "CalVRConnections.h"

#include <cvrKernel/ComController.h>

namespace osgRayTrace::calvr
{

bool CalVRConnections::isMaster() const
{
    return cvr::ComController::instance()->isMaster();
}

int CalVRConnections::slaveCount() const
{
    return cvr::ComController::instance()->getNumSlaves();
}

bool CalVRConnections::sendToMaster(const void* data, int bytes)
{
    return cvr::ComController::instance()->sendMaster(const_cast<void*>(data), bytes);
}

bool CalVRConnections::readFromSlaves(void* data, int bytesOfEach)
{
    return cvr::ComController::instance()->readSlaves(data, bytesOfEach);
}

bool CalVRConnections::sendToSlaves(const void* data, int bytes)
{
    return cvr::ComController::instance()->sendSlaves(const_cast<void*>(data), bytes);
}

bool CalVRConnections::readFromMaster(void* data, int bytes)
{
    return cvr::ComController::instance()->readMaster(data, bytes);
}

} // namespace osgRayTrace::calvr
