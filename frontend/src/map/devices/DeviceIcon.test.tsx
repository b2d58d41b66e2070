import { renderToStaticMarkup } from "react-dom/server";
import { expect, test } from "vitest";
import { DeviceIcon } from "./DeviceIcon";
import { MachineBody } from "./MachineBody";

const WORDS = ["constructor", "toString", "__proto__", "hasOwnProperty"];
const icon = (deviceClass: string) => renderToStaticMarkup(<DeviceIcon deviceClass={deviceClass} />);
const body = (deviceClass: string) =>
  renderToStaticMarkup(<MachineBody deviceClass={deviceClass} width={40} height={20} />);

test.each(WORDS)("a device of the class %s looks as one of any class that nobody knows", (word) => {
  expect(icon(word)).toBe(icon("kiln"));
  expect(body(word)).toBe(body("kiln"));
});

test("a class has its own icon by the name of its file, or one of Lucide's", () => {
  const plain = icon("kiln");
  for (const known of ["mixer", "oven", "turtlebot", "shelf", "cans", "booth", "rollers"])
    expect(icon(known)).not.toBe(plain);
});
