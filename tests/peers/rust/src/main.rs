//! Drives a robot: says where it is on `odom`, and hears where it is to go on `goal_pose`.
//!
//!   rust_driver DOMAIN NAMESPACE SECONDS
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use rustdds::policy::{Durability, History, Reliability};
use rustdds::{DomainParticipantBuilder, QosPolicyBuilder, TopicKind};
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Time {
    sec: i32,
    nanosec: u32,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Header {
    stamp: Time,
    frame_id: String,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Pose {
    position: Vector3,
    orientation: Quaternion,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Twist {
    linear: Vector3,
    angular: Vector3,
}

/// 36 numbers in a row: serde knows arrays only up to 32.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Covariance([f64; 32], [f64; 4]);

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Odometry {
    header: Header,
    child_frame_id: String,
    pose: Pose,
    pose_covariance: Covariance,
    twist: Twist,
    twist_covariance: Covariance,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct PoseStamped {
    header: Header,
    pose: Pose,
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let domain: u16 = arguments[1].parse().expect("a domain");
    let space = &arguments[2];
    let seconds: f64 = arguments[3].parse().expect("seconds");
    let participant = DomainParticipantBuilder::new(domain)
        .build()
        .expect("a participant");
    let reliable = QosPolicyBuilder::new()
        .reliability(Reliability::Reliable {
            max_blocking_time: rustdds::Duration::from_millis(100),
        })
        .durability(Durability::Volatile)
        .history(History::KeepLast { depth: 10 })
        .build();
    let odom = participant
        .create_topic(
            format!("rt/{space}/odom"),
            "nav_msgs::msg::dds_::Odometry_".to_string(),
            &reliable,
            TopicKind::NoKey,
        )
        .expect("a topic");
    let goal = participant
        .create_topic(
            format!("rt/{space}/goal_pose"),
            "geometry_msgs::msg::dds_::PoseStamped_".to_string(),
            &reliable,
            TopicKind::NoKey,
        )
        .expect("a topic");
    let publisher = participant.create_publisher(&reliable).expect("a publisher");
    let subscriber = participant.create_subscriber(&reliable).expect("a subscriber");
    let writer = publisher
        .create_datawriter_no_key_cdr::<Odometry>(&odom, None)
        .expect("a writer");
    let mut reader = subscriber
        .create_datareader_no_key_cdr::<PoseStamped>(&goal, None)
        .expect("a reader");

    let end = Instant::now() + Duration::from_secs_f64(seconds);
    let mut goals = 0;
    let mut last = PoseStamped::default();
    while Instant::now() < end {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("a clock");
        let mut message = Odometry::default();
        message.header.stamp = Time { sec: now.as_secs() as i32, nanosec: now.subsec_nanos() };
        message.header.frame_id = "map".to_string();
        message.child_frame_id = format!("{space}/base_link");
        message.pose.position = Vector3 { x: 1.0, y: 2.0, z: 0.0 };
        message.pose.orientation.w = 1.0;
        writer.write(message, None).expect("room for a message");
        while let Ok(Some(sample)) = reader.take_next_sample() {
            goals += 1;
            last = sample.into_value();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let p = &last.pose.position;
    println!("goals {goals} at {:.3} {:.3} in {}", p.x, p.y, last.header.frame_id);
}
