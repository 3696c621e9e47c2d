# UNTESTED, see README.md.
# ros2 launch pole_pf.launch.py folder:=FOLDER points:=/velodyne_points odom:=/odom
# FOLDER holds map.ini, map.polemap and pf.yaml; it is also the working directory, for the map's relative path.
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node


def generate_launch_description():
    folder = LaunchConfiguration("folder")
    return LaunchDescription([
        DeclareLaunchArgument("folder"),
        DeclareLaunchArgument("points", default_value="/points"),
        DeclareLaunchArgument("odom", default_value="/odom"),
        Node(
            package="pole_pf",
            executable="pole_pf_node",
            cwd=folder,
            parameters=[{
                "pf_params": PathJoinSubstitution([folder, "pf.yaml"]),
                "map_ini": PathJoinSubstitution([folder, "map.ini"]),
                "lidar": "vlp16",
                "lidar_height": 1.0,
            }],
            remappings=[("points", LaunchConfiguration("points")), ("odom", LaunchConfiguration("odom"))],
            output="screen",
        ),
    ])
