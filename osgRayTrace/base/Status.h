// Status.h - the outcome of an operation on a resource, and the engine's exception. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace osgRayTrace::engine
{

enum class StatusCode
{
    Ok,
    Cancelled,     ///< a request to stop
    EmptyScene,    ///< nothing to trace; the picture is the background
    InvalidView,   ///< a size of zero, too large, or matrices that cannot be inverted
    OutOfMemory,   ///< a failed allocation, or a resource cap that was reached
    DeviceFailure, ///< an error that Embree reported
};

struct Status
{
    StatusCode code = StatusCode::Ok;
    std::string message; ///< one sentence for the user; empty when Ok

    bool ok() const { return code == StatusCode::Ok; }
};

/// Returns the message as a string. If memory is short, the string is a text that fits into a
/// std::string without an allocation.
inline std::string failureText(const char* message) noexcept
{
    try
    {
        return message;
    }
    catch (const std::exception&)
    {
        return "out of memory";
    }
}

/// Returns the outcome of a failed operation, for places that must not throw.
inline Status failure(StatusCode code, const char* message) noexcept
{
    return {code, failureText(message)};
}

/// An exception inside the engine; RenderSession and the public API turn it into a Status.
class EngineError : public std::runtime_error
{
public:
    EngineError(StatusCode code, const std::string& message)
        : std::runtime_error(message), _code(code)
    {
    }
    StatusCode code() const { return _code; }

private:
    StatusCode _code;
};

} // namespace osgRayTrace::engine
