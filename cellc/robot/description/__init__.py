"""From URDF or xacro to one typed robot model: links, joints, shapes, and the hardware of ``<ros2_control>``.

Read in this order: ``model`` says what a robot is; ``xml_tree``, ``urdf_values``, ``urdf_reader`` and ``ros2_control``
read it from URDF; ``xacro_expression``, ``xacro_names``, ``xacro_files``, ``xacro_confinement`` and ``xacro_expansion``
turn xacro into URDF without letting it out of its folder; ``read_description`` takes either.
"""
