#!/usr/bin/env python3
"""Listens to the odometry of a robot with the Python binding of another version of Cyclone DDS, its types written by hand, and
prints what it heard: how many messages, and the last one.

  cyclonedds_listener.py DOMAIN NAMESPACE SECONDS
"""
import os
import sys
import time
from dataclasses import dataclass

os.environ["CYCLONEDDS_URI"] = ('<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>'
                                "</General></Domain></CycloneDDS>")
from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import IdlStruct  # noqa: E402
from cyclonedds.idl.annotations import final  # noqa: E402
from cyclonedds.idl.types import array, float64, int32, uint32  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402


@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: int32
    nanosec: uint32


@dataclass
@final
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time
    frame_id: str


@dataclass
@final
class Vector3(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
@final
class Quaternion(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
@final
class Pose(IdlStruct, typename="geometry_msgs.msg.dds_.Pose_"):
    position: Vector3
    orientation: Quaternion


@dataclass
@final
class PoseWithCovariance(IdlStruct, typename="geometry_msgs.msg.dds_.PoseWithCovariance_"):
    pose: Pose
    covariance: array[float64, 36]


@dataclass
@final
class Twist(IdlStruct, typename="geometry_msgs.msg.dds_.Twist_"):
    linear: Vector3
    angular: Vector3


@dataclass
@final
class TwistWithCovariance(IdlStruct, typename="geometry_msgs.msg.dds_.TwistWithCovariance_"):
    twist: Twist
    covariance: array[float64, 36]


@dataclass
@final
class Odometry(IdlStruct, typename="nav_msgs.msg.dds_.Odometry_"):
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


def main():
    domain, space, seconds = int(sys.argv[1]), sys.argv[2], float(sys.argv[3])
    participant = DomainParticipant(domain)
    qos = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(10), Policy.DataRepresentation(use_cdrv0_representation=True))
    reader = DataReader(participant, Topic(participant, f"rt/{space}/odom", Odometry), qos=qos)
    end = time.monotonic() + seconds
    count, last = 0, None
    while time.monotonic() < end:
        for sample in reader.take(N=100):
            count, last = count + 1, sample
        time.sleep(0.02)
    if last is None:
        print("nothing")
        return 1
    print(count, last.header.frame_id, last.child_frame_id, round(last.pose.pose.position.x, 3), round(last.pose.pose.position.y, 3))
    return 0


if __name__ == "__main__":
    sys.exit(main())
