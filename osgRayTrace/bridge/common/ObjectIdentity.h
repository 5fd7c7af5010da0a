// ObjectIdentity.h - OSG's objects told apart by more than an address. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Observer>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// An address is an identity only while its object lives: malloc gives the address of a deleted
/// object to the next one of its size. So whatever is compared by address is either kept alive, as
/// Kept does, or known by its ObjectName.

struct Unref
{
    void operator()(const osg::Referenced* object) const { object->unref(); }
};

/// An osg::ref_ptr that can be moved without a change of the reference count.
template <class T> using Kept = std::unique_ptr<T, Unref>;

/// One more reference to the object; null stays null.
template <class T> Kept<T> keep(T* object)
{
    if (object) object->ref();
    return Kept<T>(object);
}

using KeptObjects = std::vector<Kept<const osg::Referenced>>;

/// Names an object and does not keep it alive: two names are equal if they are of one object, also
/// once it is deleted.
class ObjectName
{
public:
    ObjectName() = default;
    ObjectName(const osg::Referenced* object)
        : _observers(object ? object->getOrCreateObserverSet() : nullptr)
    {
    }

    bool operator==(const ObjectName& other) const { return _observers == other._observers; }
    bool operator!=(const ObjectName& other) const { return !(*this == other); }

    /// The same name without OSG, for the engine: equal if the names are. Null for no object.
    std::shared_ptr<const void> hostName() const
    {
        if (!_observers) return nullptr;
        return {_observers.get(), [kept = _observers](const void*) {}};
    }

private:
    osg::ref_ptr<osg::ObserverSet> _observers; ///< every object has its own, which outlives it here
};

} // namespace osgRayTrace::engine
