#include "model/joints.h"

#include "base/number.h"

#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <cmath>

namespace spawnfield {
namespace {

const char* unit_of(const Joint& joint) { return joint.motion == Joint::Motion::Sliding ? "m" : "rad"; }

std::string limits_of(const Joint& joint)
{
    return number(joint.lower) + " to " + number(joint.upper) + " " + unit_of(joint);
}

bool is_within(const Joint& joint, double value)
{
    constexpr double tolerance = 1e-9;  // limits are often rounded
    return value >= joint.lower - tolerance && value <= joint.upper + tolerance;
}

class Positions {
public:
    Positions(const std::string& file, const std::vector<Joint>& joints, const std::vector<JointPosition>& given)
        : file_(file), joints_(joints)
    {
        for (const Joint& joint : joints) by_name_.emplace(joint.name, &joint);
        for (const JointPosition& position : given) take(position);
    }

    std::map<std::string, double> all(std::vector<std::string>& notices)
    {
        std::map<std::string, double> out;
        for (const Joint& joint : joints_) {
            if (joint.motion != Joint::Motion::Turning && joint.motion != Joint::Motion::Sliding) continue;
            const double value = out[joint.name] = value_of(joint);
            if (is_within(joint, value)) continue;
            notices.push_back(file_ + ": joint \"" + joint.name + "\" is at " + number(value) + " " + unit_of(joint) +
                              (joint.mimic ? ", because it mimics \"" + joint.mimic->joint + "\"" : "") +
                              ", outside its limits " + limits_of(joint));
        }
        return out;
    }

private:
    void take(const JointPosition& position)
    {
        const std::string place = "joint \"" + position.joint + "\" ";
        const Joint* const joint = find(position.joint);
        if (joint == nullptr) refuse(place + "is not in " + file_ + "; " + movable());
        if (joint->motion == Joint::Motion::None) refuse(place + "is fixed in " + file_ + "; " + movable());
        if (joint->motion == Joint::Motion::Other)
            refuse(place + "is of type " + joint->type + ", which cannot be moved by one number; " + movable());
        if (joint->mimic) refuse(place + "mimics joint \"" + joint->mimic->joint + "\"; give that one instead");
        if (!std::isfinite(position.value)) refuse(place + "is " + number(position.value) + ", needs a finite number");
        if (!is_within(*joint, position.value))
            refuse(place + "is " + number(position.value) + ", outside its limits in " + file_ + ", " +
                   limits_of(*joint));
        if (!given_.emplace(position.joint, position.value).second) refuse(place + "is given twice");
    }

    /// Follows a chain of joints that mimic each other to a known value, and then back. There is no recursion, because
    /// a chain may be longer than the call stack.
    double value_of(const Joint& joint)
    {
        std::vector<const Joint*> chain;
        for (const Joint* next = &joint; next != nullptr && !values_.contains(next); next = leader_of(*next)) {
            if (chain.size() > joints_.size()) throw FileError(file_, "joint \"" + next->name + "\" mimics itself");
            chain.push_back(next);
        }
        for (auto at = chain.rbegin(); at != chain.rend(); ++at) values_[*at] = value_after(**at);
        return values_.at(&joint);
    }

    /// Returns the position of a joint. That of the joint which it mimics must be known.
    double value_after(const Joint& joint) const
    {
        if (joint.mimic) return joint.mimic->multiplier * values_.at(leader_of(joint)) + joint.mimic->offset;
        const auto entry = given_.find(joint.name);
        return entry == given_.end() ? 0 : entry->second;
    }

    /// Returns the joint that a joint mimics; nullptr if it mimics none.
    const Joint* leader_of(const Joint& joint) const
    {
        if (!joint.mimic) return nullptr;
        const Joint* const leader = find(joint.mimic->joint);
        if (leader == nullptr)
            throw FileError(file_,
                            "joint \"" + joint.name + "\" mimics \"" + joint.mimic->joint + "\", which is not a joint");
        return leader;
    }

    const Joint* find(const std::string& name) const
    {
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? nullptr : found->second;
    }

    /// Returns the joints that can be given, for messages.
    std::string movable() const
    {
        std::string names;
        for (const Joint& joint : joints_)
            if ((joint.motion == Joint::Motion::Turning || joint.motion == Joint::Motion::Sliding) && !joint.mimic)
                names += (names.empty() ? "" : ", ") + joint.name;
        return names.empty() ? "no joint there can be moved" : "joints that can be moved: " + names;
    }

    [[noreturn]] static void refuse(const std::string& what) { throw ArgumentError("load_robot", what); }

    const std::string& file_;
    const std::vector<Joint>& joints_;
    std::map<std::string, const Joint*> by_name_;
    std::map<std::string, double> given_;
    std::map<const Joint*, double> values_;  ///< the known ones
};

}  // namespace

std::map<std::string, double> joint_positions(const std::string& file, const std::vector<Joint>& joints,
                                              const std::vector<JointPosition>& given,
                                              std::vector<std::string>& notices)
{
    return Positions(file, joints, given).all(notices);
}

Pose joint_motion(Joint::Motion motion, const Vec3& axis, double value)
{
    if (value == 0) return {};  // exactly the same numbers as without a joint
    if (motion == Joint::Motion::Sliding) return {value * axis, Mat3::Identity()};
    return {Vec3::Zero(), Eigen::AngleAxisd(value, axis).toRotationMatrix()};
}

}  // namespace spawnfield
