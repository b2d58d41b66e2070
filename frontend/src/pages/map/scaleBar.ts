/** The longest of 1, 2 or 5 times a power of ten metres that is no wider than so many pixels of the screen. */
export function scaleBar(zoom: number, pixelsPerMetre: number, most: number): { metres: number; pixels: number } {
  const perMetre = zoom * pixelsPerMetre;
  const power = 10 ** Math.floor(Math.log10(most / perMetre));
  const metres = [5, 2, 1].map((each) => each * power).find((each) => each * perMetre <= most) ?? power;
  return { metres, pixels: metres * perMetre };
}
