"""Checks the launch files for ROS 1. The arguments of each node are parsed like those of spawn_model.

If roslaunch is installed, its own loader reads the files, too.
"""
import argparse
import shlex
import xml.etree.ElementTree

from truth import FOLDER, MODELS, ROBOTS, URDF, check_pose, from_rpy

try:
    import roslaunch.config
    import roslaunch.xmlloader
except ImportError:
    roslaunch = None


def spawn_model(arguments):
    """Parses arguments like spawn_model of gazebo_ros."""
    parser = argparse.ArgumentParser()
    kind = parser.add_mutually_exclusive_group(required=True)
    kind.add_argument('-urdf', action='store_true')
    kind.add_argument('-sdf', action='store_true')
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument('-file')
    source.add_argument('-param')
    parser.add_argument('-model', required=True)
    for name in 'xyzRPY':
        parser.add_argument('-' + name, type=float, required=True)
    return parser.parse_args(arguments)


def groups(file):
    """Yields the namespace, the parameters and the arguments of spawn_model for each group."""
    for group in xml.etree.ElementTree.parse(file).getroot().findall('group'):
        node, = group.findall('node')
        assert (node.get('pkg'), node.get('type')) == ('gazebo_ros', 'spawn_model')
        parameters = {p.get('name'): p.get('textfile') for p in group.findall('param')}
        yield group.get('ns'), parameters, shlex.split(node.get('args'))


for name in ('file', 'sdf', 'topic'):
    read = list(groups(FOLDER / (name + '.launch')))
    assert len(read) == len(ROBOTS)
    for robot, (namespace, parameters, arguments) in zip(ROBOTS, read):
        assert namespace == robot['namespace']
        args = spawn_model(arguments)
        assert args.model == robot['name']
        assert args.sdf == (name == 'sdf')
        assert args.file == ("/opt/a robot's/husky.sdf" if name == 'sdf' else None)
        assert args.param == {'file': 'robot_description', 'sdf': None, 'topic': 'description'}[name]
        assert parameters == ({'robot_description': URDF} if name == 'file' else {})
        check_pose(robot, (args.x, args.y, args.z), from_rpy(args.R, args.P, args.Y))

read = list(groups(FOLDER / 'fleet.launch'))
assert len(read) == len(ROBOTS)
for number, (robot, (namespace, parameters, arguments)) in enumerate(zip(ROBOTS, read)):
    args = spawn_model(arguments)
    assert (namespace, args.model) == (robot['namespace'], robot['name'])
    assert parameters == ({} if number % 2 else {'robot_description': MODELS[0]})
    assert (args.sdf, args.file) == ((True, MODELS[1]) if number % 2 else (False, None))
    check_pose(robot, (args.x, args.y, args.z), from_rpy(args.R, args.P, args.Y))

for _, parameters, arguments in groups(FOLDER / 'find.launch'):
    assert parameters == {'robot_description': '$(find roslaunch)/husky.urdf'}

if roslaunch is not None:
    for name in ('sdf', 'topic'):
        config = roslaunch.config.ROSLaunchConfig()
        roslaunch.xmlloader.XmlLoader().load(str(FOLDER / (name + '.launch')), config, verbose=False)
        assert len(config.nodes) == len(ROBOTS)
        for robot, node in zip(ROBOTS, config.nodes):
            assert node.namespace == '/' + robot['namespace'] + '/'
            args = spawn_model(shlex.split(node.args))
            assert args.model == robot['name']
            check_pose(robot, (args.x, args.y, args.z), from_rpy(args.R, args.P, args.Y))
print('roslaunch', 'read the files, too' if roslaunch is not None else 'is not installed; install python3-roslaunch')
