// Status.h - the outcome of an operation on a resource, and the exception inside the engine. Layer:
// base.
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
    Cancelled,     ///< somebody asked to stop
    EmptyScene,    ///< nothing to trace; the picture is the background
    InvalidView,   ///< zero size, too large, or matrices that cannot be inverted
    OutOfMemory,   ///< an allocation failed, or a resource cap was reached
    DeviceFailure, ///< Embree reported an error
};

struct Status
{
    StatusCode code = StatusCode::Ok;
    std::string message; ///< one sentence for the user; empty when Ok

    bool ok() const { return code == StatusCode::Ok; }
};

/// The message as text. Memory may be what is missing: then the text is one that fits into a string
/// as it is.
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

/// The outcome of what has failed; for places that must not throw.
inline Status failure(StatusCode code, const char* message) noexcept
{
    return {code, failureText(message)};
}

/// Thrown inside the engine only; RenderSession and the public API turn it into a Status.
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
