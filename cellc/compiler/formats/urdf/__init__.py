"""The robot description as URDF, of one target: links, joints, frames, scene and hardware."""
