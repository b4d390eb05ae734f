#!/usr/bin/env python3
"""Writes what a Vulkan device can report, for truth_test.cpp, from the registry.

usage: reported.py vk.xml OUT_DIR

Output: reported_features.inc, reported_properties.inc, reported_limits.inc, reported_formats.inc, with lines

  VERNIER_FEATURES(type, sType)        a structure that extends VkPhysicalDeviceFeatures2
  VERNIER_FEATURE(type, member)        a member of one, or of VkPhysicalDeviceFeatures
  VERNIER_PROPERTIES(type, sType)      a structure that extends VkPhysicalDeviceProperties2
  VERNIER_PROPERTY(type, member)
  VERNIER_LIMIT(member)                of VkPhysicalDeviceLimits
  VERNIER_FORMAT_BIT(short name, VkFormatFeatureFlagBits)
  VERNIER_FORMAT(format)
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def main():
    root = ElementTree.parse(sys.argv[1]).getroot()
    # Structures of platforms and of provisional extensions are in headers of their own.
    elsewhere = set()
    for extension in root.findall("extensions/extension"):
        hidden = extension.get("platform") or extension.get("supported") == "disabled"
        if hidden:
            elsewhere.update(t.get("name") for t in extension.findall("require/type"))
    owners = root.findall("feature") + [e for e in root.findall("extensions/extension")
                                        if not e.get("platform") and e.get("supported") != "disabled"]
    def write(group, lines):
        path = pathlib.Path(sys.argv[2]) / ("reported_%s.inc" % group.lower())
        path.write_text("// Written by tests/vulkan/reported.py from vk.xml.\n" + "\n".join(lines) + "\n")


    def members(struct):
        for member in struct.findall("member"):
            name = member.find("name").text
            if name not in ("sType", "pNext"):
                yield name

    structs = {s.get("name"): s for s in root.findall("types/type[@category='struct']") if not s.get("alias")}
    for extended, group, one in (("VkPhysicalDeviceFeatures2", "FEATURES", "FEATURE"),
                                 ("VkPhysicalDeviceProperties2", "PROPERTIES", "PROPERTY")):
        lines = []
        for name, struct in structs.items():
            if extended not in (struct.get("structextends") or "").split(",") or name in elsewhere:
                continue
            value = next(m.get("values") for m in struct.findall("member") if m.find("name").text == "sType")
            lines.append("VERNIER_%s(%s, %s)" % (group, name, value))
            lines += ["VERNIER_%s(%s, %s)" % (one, name, member) for member in members(struct)]
        if one == "FEATURE":
            lines += ["VERNIER_FEATURE(VkPhysicalDeviceFeatures, %s)" % m
                      for m in members(structs["VkPhysicalDeviceFeatures"])]
        write(group, lines)
    write("LIMITS", ["VERNIER_LIMIT(%s)" % m for m in members(structs["VkPhysicalDeviceLimits"])])

    def values(enum):
        group = root.find("enums[@name='%s']" % enum)
        found = [e.get("name") for e in group.findall("enum") if not e.get("alias")]
        for owner in owners:
            found += [e.get("name") for e in owner.findall("require/enum[@extends='%s']" % enum) if not e.get("alias")]
        return list(dict.fromkeys(found))

    prefix = "VK_FORMAT_FEATURE_"
    lines = ["VERNIER_FORMAT_BIT(%s, %s)" % (v[len(prefix):].replace("_BIT", "", 1), v)
             for v in values("VkFormatFeatureFlagBits")]
    lines += ["VERNIER_FORMAT(%s)" % v for v in values("VkFormat") if v != "VK_FORMAT_UNDEFINED"]
    write("FORMATS", lines)


main()
