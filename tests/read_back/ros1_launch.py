"""ROS 1: every file as roslaunch reads it (by roslaunch's own loader where it is installed), every node as spawn_model does."""
import argparse
import shlex
import xml.etree.ElementTree

from truth import FOLDER, ROBOTS, URDF, check_pose, from_rpy

try:
    import roslaunch.config
    import roslaunch.xmlloader
except ImportError:
    roslaunch = None


def spawn_model(arguments):
    """As gazebo_ros's spawn_model takes them."""
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
    """Namespace, parameters and spawn_model's arguments of each group."""
    for group in xml.etree.ElementTree.parse(file).getroot().findall('group'):
        node, = group.findall('node')
        assert (node.get('pkg'), node.get('type')) == ('gazebo_ros', 'spawn_model')
        yield group.get('ns'), {p.get('name'): p.get('textfile') for p in group.findall('param')}, shlex.split(node.get('args'))


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
print('roslaunch', 'read them too' if roslaunch is not None else 'is not installed (python3-roslaunch)')
