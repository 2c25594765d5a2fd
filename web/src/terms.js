// What the names of numbers mean, for tooltips and the help.
export const TERMS = {
  Position: "the robot's origin (x, y, z)",
  Heading: 'its yaw: 0 looks along x, positive is counterclockwise seen from above',
  Ground: 'height of the ground below its origin',
  Tilt: 'angle between its z axis and the vertical when it stands',
  Margin: 'distance of its centre of mass, seen from above, from the edge of its support; negative: it tips over',
  Clearance: 'the shortest horizontal shift with which it touches an obstacle; drops do not count',
  Head_room: 'how far it can be raised until it touches something',
  Roughness: 'how far the ground below it is from a plane',
  View: 'share of directions in which it sees far',
  Contacts: 'places where it touches the ground; the frame around them is its support',
  Island: 'ground within which it can drive; the largest island is 0',
};
