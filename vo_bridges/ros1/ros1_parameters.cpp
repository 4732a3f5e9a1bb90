#include "vo_bridges/ros1/ros1_parameters.hpp"

#include <ros/param.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cmath>
#include <limits>

namespace overfly::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue value_from(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  const bool whole = number == std::floor(number) &&
                     std::abs(number) <= static_cast<double>(std::numeric_limits<int>::max());
  if (whole) return static_cast<int>(number);
  return number;
}

/// Expands structures by their names; converts all other values to text.
void flatten(const std::string& name, XmlRpcValue& value, std::map<std::string, std::string>& out) {
  switch (value.getType()) {
    case XmlRpcValue::TypeStruct:
      for (auto& [member, inner] : value) {
        flatten(name.empty() ? member : name + "/" + member, inner, out);
      }
      return;
    case XmlRpcValue::TypeBoolean:
      out[name] = text_of(static_cast<bool>(value));
      return;
    case XmlRpcValue::TypeInt:
      out[name] = std::to_string(static_cast<int>(value));
      return;
    case XmlRpcValue::TypeDouble:
      out[name] = text_of(static_cast<double>(value));
      return;
    case XmlRpcValue::TypeString:
      out[name] = static_cast<std::string>(value);
      return;
    default:
      out[name] = value.toXml();
  }
}

}  // namespace

Status write_parameters(const std::string& name_space, const VoParameters& parameters) {
  for (const auto& [name, value] : parameters) {
    const std::string key = name_space + "/" + name;
    try {
      ros::param::set(key, value_from(value));
    } catch (const std::exception& failure) {
      return Error{ErrorCode::kInternal, "parameter " + key + ": " + failure.what()};
    }
  }
  return {};
}

std::map<std::string, std::string> read_parameters(const std::string& name_space) {
  std::map<std::string, std::string> out;
  try {
    XmlRpcValue value;
    if (ros::param::get(name_space, value)) flatten("", value, out);
  } catch (const std::exception&) {
    out.clear();  // an invalid ROS name has no parameters
  } catch (const XmlRpc::XmlRpcException&) {
    out.clear();
  }
  return out;
}

}  // namespace overfly::ros1
