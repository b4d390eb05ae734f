#!/usr/bin/env python3
"""Writes the driver's tables from the Vulkan registry.

usage: generate.py vk.xml MINOR_VERSION ENTRY_POINTS.def EXTENSIONS.def OUT_DIR

Reads which commands and extensions the driver implements from the two lists, takes everything else about them from the
registry, and fails when a list names something the registry does not know. Output:

  entry_points.inc     VERNIER_ENTRY_ROW(name, function, level, core version or 0, extensions that bring it), by name
  core_commands.inc    VERNIER_CORE_COMMAND(name, level, implemented) for every command of Vulkan 1.0 to 1.MINOR_VERSION;
                       for tests
  extensions.inc       VERNIER_EXTENSION_ROW(identifier, "name", spec version, isInstance)
  structures.inc       VERNIER_STRUCTURE(type, sType value) for every structure that can stand in a pNext chain
  enum_names.inc       VERNIER_ENUM_NAME(enum type, value) for the enums that messages print
"""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

PRINTED_ENUMS = ["VkResult", "VkFormat", "VkDescriptorType", "VkObjectType"]
LEVEL_OF_FIRST_PARAMETER = {"VkInstance": "instance", "VkPhysicalDevice": "physicalDevice", "VkDevice": "device",
                            "VkQueue": "device", "VkCommandBuffer": "device"}


def fail(message):
    sys.exit("generate.py: " + message)


def listed(path, macro):
    """The arguments of MACRO(...) lines of an X-macro list, in order."""
    names = re.findall(r"^%s\((\w+)\)" % macro, pathlib.Path(path).read_text(), re.M)
    if not names:
        fail("%s has no %s(...) line" % (path, macro))
    if len(set(names)) != len(names):
        fail("%s names something twice: %s" % (path, sorted(n for n in names if names.count(n) > 1)))
    return names


class Registry:
    def __init__(self, path, minor):
        self.minor = minor
        self.root = ElementTree.parse(path).getroot()
        self.first_parameter, self.alias_of = {}, {}
        for command in self.root.findall("commands/command"):
            if command.get("alias"):
                self.alias_of[command.get("name")] = command.get("alias")
            else:
                name = command.find("proto/name").text
                self.first_parameter[name] = command.find("param/type").text
        self.extensions = {e.get("name"): e for e in self.root.findall("extensions/extension")
                           if "vulkan" in e.get("supported", "").split(",")}
        self.features = [f for f in self.root.findall("feature") if "vulkan" in f.get("api", "").split(",")]

    def resolve(self, name):
        while name in self.alias_of:
            name = self.alias_of[name]
        return name

    def spec_version(self, extension):
        for enum in self.extensions[extension].findall("require/enum"):
            if enum.get("name", "").endswith("_SPEC_VERSION"):
                return int(enum.get("value"))
        fail(extension + " has no spec version")

    def level(self, name):
        if name == "vkGetInstanceProcAddr":  # takes an instance, but also none at all
            return "loader"
        return LEVEL_OF_FIRST_PARAMETER.get(self.first_parameter[self.resolve(name)], "loader")

    def is_ours(self, feature):
        """Whether VK_VERSION_1_n, or its number, is one of the core versions that the driver has."""
        major, minor = re.fullmatch(r"(?:VK_VERSION_)?(\d)[._](\d)", feature).groups()
        return major == "1" and int(minor) <= self.minor

    def providers(self):
        """command -> (core version or 0, [extensions])"""
        result = {}
        for feature in self.features:
            major, minor = feature.get("number").split(".")
            for command in feature.findall("require/command"):
                result.setdefault(command.get("name"), [0, []])[0] = "VK_API_VERSION_%s_%s" % (major, minor)
        for name, extension in self.extensions.items():
            for require in extension.findall("require"):
                # A block under a condition belongs to the pair: of extensions, which is not taken, or with a core version.
                if require.get("extension") or require.get("depends"):
                    continue
                if require.get("feature") and not self.is_ours(require.get("feature")):
                    continue
                for command in require.findall("command"):
                    result.setdefault(command.get("name"), [0, []])[1].append(name)
        return result

    def structures(self):
        protected = set()
        for extension in self.root.findall("extensions/extension"):
            if extension.get("name") not in self.extensions or extension.get("platform"):
                protected.update(t.get("name") for t in extension.findall("require/type"))
        for struct in self.root.findall("types/type[@category='struct']"):
            if struct.get("alias") or struct.get("name") in protected:
                continue
            for member in struct.findall("member"):
                if member.find("name").text == "sType" and member.get("values"):
                    yield struct.get("name"), member.get("values")

    def enum_values(self, enum):
        group = self.root.find("enums[@name='%s']" % enum)
        if group is None:
            fail("no enum " + enum)
        for value in group.findall("enum"):
            if not value.get("alias"):
                yield value.get("name")
        owners = self.features + [e for e in self.extensions.values() if not e.get("platform")]
        seen = set()
        for owner in owners:
            for value in owner.findall("require/enum[@extends='%s']" % enum):
                if not value.get("alias") and value.get("name") not in seen:
                    seen.add(value.get("name"))
                    yield value.get("name")


def main():
    if len(sys.argv) != 6:
        fail("wrong arguments\n" + __doc__)
    registry = Registry(sys.argv[1], int(sys.argv[2]))
    commands = ["vk" + name for name in listed(sys.argv[3], "VERNIER_ENTRY_POINT")]
    extensions = ["VK_" + name for name in listed(sys.argv[4], "VERNIER_EXTENSION")]
    out = pathlib.Path(sys.argv[5])
    out.mkdir(parents=True, exist_ok=True)

    for name in commands:
        if name not in registry.first_parameter:
            fail("%s is not a command of the registry (list the name that others are aliases of)" % name)
    for name in extensions:
        if name not in registry.extensions:
            fail("%s is not an extension of the registry" % name)

    providers = registry.providers()
    rows = []
    for name, (core, bringing) in sorted(providers.items()):
        function = registry.resolve(name)
        if function not in commands:
            continue
        ours = [e for e in bringing if e in extensions]
        mask = " | ".join("ExtensionSet(Extension::%s)" % e[3:] for e in ours) or "ExtensionSet()"
        if core or ours:
            rows.append("VERNIER_ENTRY_ROW(%s, %s, %s, %s, %s)" %
                        (name, function[2:], registry.level(name), core or "0", mask))
    reachable = {r.split(", ")[1] for r in rows}
    for name in commands:
        if name[2:] not in reachable:
            fail("%s is listed, but neither a core version nor a listed extension brings it" % name)

    def write(name, lines):
        (out / name).write_text("// Written by api/vulkan/gen/generate.py from vk.xml.\n" + "\n".join(lines) + "\n")

    write("entry_points.inc", rows)
    ours = ["VK_API_VERSION_1_%d" % minor for minor in range(registry.minor + 1)]
    write("core_commands.inc", ["VERNIER_CORE_COMMAND(%s, %s, %s)" %
                                (name, registry.level(name), "true" if name in commands else "false")
                                for name, (core, _) in sorted(providers.items()) if core in ours])
    write("extensions.inc", ['VERNIER_EXTENSION_ROW(%s, "%s", %d, %s)' %
                             (name[3:], name, registry.spec_version(name),
                              "true" if registry.extensions[name].get("type") == "instance" else "false")
                             for name in extensions])
    write("structures.inc", ["VERNIER_STRUCTURE(%s, %s)" % pair for pair in registry.structures()])
    write("enum_names.inc", ["VERNIER_ENUM_NAME(%s, %s)" % (enum, value)
                             for enum in PRINTED_ENUMS for value in registry.enum_values(enum)])


main()
