// CalVRConnections.cpp - calls of ComController, which takes what it sends as not const. Layer:
// plugins. SPDX-License-Identifier: MIT
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

bool CalVRConnections::sendToMaster(const int& value)
{
    return cvr::ComController::instance()->sendMaster(const_cast<int*>(&value), sizeof value);
}

bool CalVRConnections::readFromSlaves(std::vector<int>& values)
{
    return cvr::ComController::instance()->readSlaves(values.data(), sizeof(int));
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
