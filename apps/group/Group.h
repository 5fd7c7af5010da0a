// Group.h - the processes that make one picture together, as they speak to each other. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/GroupMessage.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace osgRayTrace::app
{

/// Ranks 0 to size - 1, which send messages and add up arrays. One thread of a process calls,
/// always the same one.
class Group
{
public:
    virtual ~Group() = default;

    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Returns how many of the ranks are on this machine.
    virtual int localSize() const = 0;

    /// Sends to another rank, and does not wait until the message is there. The messages of a rank
    /// to another one come in the order in which they were sent.
    virtual void send(int rank, const GroupMessage& message) = 0;

    /// Returns a message that has come, and who sent it; nothing if none has.
    virtual std::optional<std::pair<int, GroupMessage>> receive() = 0;

    /// Begins to add up the arrays of all ranks, value by value; that of rank 0 becomes the sum.
    /// All ranks call with equal counts, once after the other, and keep the array till sumIsDone().
    virtual void beginSum(std::int64_t* values, std::size_t count) = 0;
    virtual bool sumIsDone() = 0;

    /// Begins to give the bytes of rank 0 to all ranks, which have room for them. All ranks call
    /// with equal counts, and keep the memory till broadcastIsDone().
    virtual void beginBroadcast(unsigned char* bytes, std::size_t count) = 0;
    virtual bool broadcastIsDone() = 0;

    /// Ends the processes of all ranks at once.
    [[noreturn]] virtual void abort(int code) = 0;
};

} // namespace osgRayTrace::app
