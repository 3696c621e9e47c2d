"""Starts the node, configures and activates it: ros2 launch polemcl_ros polemcl.launch.py params:=MY.yaml"""
from pathlib import Path

import launch
import lifecycle_msgs.msg
from ament_index_python.packages import get_package_share_directory
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState

TRANSITION = lifecycle_msgs.msg.Transition


def generate_launch_description():
    parameters = Path(get_package_share_directory("polemcl_ros")) / "config" / "polemcl.yaml"
    node = LifecycleNode(package="polemcl_ros", executable="localizer", name="polemcl", namespace="", output="screen",
                         parameters=[LaunchConfiguration("params")],
                         remappings=[("points", LaunchConfiguration("points")), ("odom", LaunchConfiguration("odom"))])

    def change(transition):
        return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition))

    configured = OnStateTransition(target_lifecycle_node=node, start_state="configuring", goal_state="inactive",
                                   entities=[change(TRANSITION.TRANSITION_ACTIVATE)])
    return launch.LaunchDescription([
        DeclareLaunchArgument("params", default_value=str(parameters), description="YAML file of parameters"),
        DeclareLaunchArgument("points", default_value="points", description="topic of the clouds"),
        DeclareLaunchArgument("odom", default_value="odom", description="topic of the odometry"),
        node,
        RegisterEventHandler(configured),
        change(TRANSITION.TRANSITION_CONFIGURE),
    ])
