"""Checks the launch files for ROS 2. Arguments are parsed like those of gflags.

The Python files run with stand-ins for launch and launch_ros. The XML files are parsed.
"""
import ast
import runpy
import shlex
import sys
import types
import xml.etree.ElementTree

from truth import FOLDER, MODELS, ROBOTS, URDF, check_pose, from_rpy


class Node:
    def __init__(self, *, package, executable, name, namespace, output, arguments):
        assert (package, executable, output) == ('ros_gz_sim', 'create', 'screen')
        assert all(isinstance(a, str) for a in arguments)
        self.namespace, self.arguments = namespace, arguments


class LaunchDescription:
    def __init__(self, entities):
        self.entities = list(entities)


def install_stand_ins():
    for name, members in (('launch', {'LaunchDescription': LaunchDescription}), ('launch_ros', {}),
                          ('launch_ros.actions', {'Node': Node})):
        module = types.ModuleType(name)
        module.__dict__.update(members)
        sys.modules[name] = module


def nodes_of_python(file):
    ast.parse(file.read_text())
    for node in runpy.run_path(str(file))['generate_launch_description']().entities:
        yield node.namespace, node.arguments


def nodes_of_xml(file):
    for node in xml.etree.ElementTree.parse(file).getroot().findall('node'):
        assert (node.get('pkg'), node.get('exec'), node.get('output')) == ('ros_gz_sim', 'create', 'screen')
        yield node.get('namespace'), shlex.split(node.get('args'))


def flags(arguments):
    names, values = arguments[::2], arguments[1::2]
    assert len(names) == len(values) and all(name.startswith('-') for name in names)
    assert len(set(names)) == len(names)
    return {name[1:]: value for name, value in zip(names, values)}


install_stand_ins()
for name in ('file.launch.py', 'topic.launch.py', 'file.launch.xml', 'topic.launch.xml', 'fleet.launch.py',
             'fleet.launch.xml'):
    file = FOLDER / name
    read = list(nodes_of_python(file) if name.endswith('.py') else nodes_of_xml(file))
    assert len(read) == len(ROBOTS)
    for number, (robot, (namespace, arguments)) in enumerate(zip(ROBOTS, read)):
        assert namespace == robot['namespace']
        got = flags(arguments)
        pose = [float(got.pop(key)) for key in 'xyzRPY']
        file_of = {'file': URDF, 'fleet': MODELS[number % 2]}.get(name.split('.')[0])
        expected = {'world': "arena's", 'file': file_of} if file_of else {'topic': 'robot_description'}
        assert got == {'name': robot['name'], **expected}
        check_pose(robot, pose[:3], from_rpy(*pose[3:]))
