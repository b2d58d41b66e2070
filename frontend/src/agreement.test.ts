/** What the server says it sends fits what rooms without a view of the API read of it; the compiler does the checking. */
import { expectTypeOf, test } from "vitest";
import type { Fault } from "@/i18n/faults";
import type { FloorPlan } from "./map/floor/floor";
import type { MapDevice } from "./map/devices/device";
import type { Compiled, ProgramDocument } from "./program/document/document";
import type { components } from "./api/schema";

type Server = components["schemas"];

test("answers of the server can be read as the frontend's types", () => {
  expectTypeOf<Server["FaultShape"]>().toExtend<Fault>();
  expectTypeOf<Server["DeviceShape"]>().toExtend<MapDevice>();
  expectTypeOf<Server["MapShape"] & { cells: Uint8Array }>().toExtend<FloorPlan>();
  expectTypeOf<Server["DocumentShape"]>().toExtend<ProgramDocument>();
  expectTypeOf<Server["CompiledShape"]>().toExtend<Compiled>();
});
