/** What the server says it sends fits the types that the pages read; the compiler does the checking. */
import { expectTypeOf, test } from "vitest";
import type * as maps from "./robotMaps";
import type { components } from "./schema";
import type * as ours from "./types";

type Server = components["schemas"];

test("answers of the server can be read as the frontend's types", () => {
  expectTypeOf<Server["Me"]>().toExtend<ours.Me>();
  expectTypeOf<Server["SiteShape"]>().toExtend<ours.Site>();
  expectTypeOf<Server["MapShape"]>().toExtend<ours.SiteMapInfo>();
  expectTypeOf<Server["DeviceShape"]>().toExtend<ours.Device>();
  expectTypeOf<Server["AlertShape"]>().toExtend<ours.Alert>();
  expectTypeOf<Server["DeviceEventShape"]>().toExtend<ours.DeviceEvent>();
  expectTypeOf<Server["CallShape"]>().toExtend<ours.MethodCall>();
  expectTypeOf<Server["SeriesShape"]>().toExtend<ours.Series>();
  expectTypeOf<Server["CompiledShape"]>().toExtend<ours.Compiled>();
  expectTypeOf<Server["RunSummaryShape"]>().toExtend<ours.RunSummary>();
  expectTypeOf<Server["RunEventShape"]>().toExtend<ours.RunEvent>();
  expectTypeOf<Server["QuestionShape"]>().toExtend<ours.Question>();
  expectTypeOf<Server["ArmedShape"]>().toExtend<ours.ArmedProgram>();
  expectTypeOf<Server["RobotMapShape"]>().toExtend<maps.RobotMapInfo>();
  expectTypeOf<Server["MapDifferenceShape"]>().toExtend<maps.MapDifference>();
  expectTypeOf<Server["MapVersionShape"]>().toExtend<maps.MapVersion>();
  expectTypeOf<Server["RouteShape"]>().toExtend<ours.RouteAnswer>();
  // A reading may be null by its type; a rehearsal records only readings that there are.
  expectTypeOf<Omit<Server["RehearsalResultShape"], "properties">>().toExtend<
    Omit<ours.RehearsalResult, "properties">
  >();
});
