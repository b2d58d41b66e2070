/** The names by which the screens call the server's shapes; the shapes themselves come from docs/openapi.json. */
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Scalar = string | number | boolean;
export type Point = Schemas["PointPlace"]["point"];
export type Words = Schemas["Words"];
/** Why something ended or was not done; devices are named as people name them. */
export type Cause = Schemas["Cause"];
/** Why something waits; devices are named by their ids. */
export type WaitReason = Schemas["WaitReason"];
/** What is wrong with something that a device sends, or was mended in it. */
export type Fault = Schemas["FaultShape"];

export type Me = Schemas["Me"];
export type User = Schemas["Person"];
export type Site = Schemas["SiteShape"];
export type Role = Site["role"];
export type Thread = Schemas["ThreadShape"];
export type MyMail = Schemas["MyMail"];
export type CommentOnRun = Schemas["CommentOnRun"];
export type ThreadBegun = Schemas["ThreadBegun"];
export type ThreadToStart = Schemas["ThreadToStart"];
export type WordsToWrite = Schemas["WordsToWrite"];
export type SiteStop = Schemas["Stop"];

export type SiteMapInfo = Schemas["MapShape"];
export type MapPlace = Schemas["PlaceShape"];
export type MapZone = Schemas["SiteZoneShape"];
export type Obstacle = Schemas["ObstacleShape"];
/** What a zone for so many robots at once cost in rehearsals. */
export type ZoneCost = Schemas["ZoneCostShape"];
/** Where robots drove in runs, and what waiting before zones cost. */
export type FloorUse = Schemas["FloorUseShape"];
export type FloorCheck = Schemas["FloorCheckShape"];
export type FloorFinding = Schemas["FloorFindingShape"];
export type FloorRemedy = Schemas["RemedyShape"];
/** A map with its cells: row by row from the bottom row, 0 free, 100 wall, 255 unknown. */
export type SiteMap = SiteMapInfo & { cells: Uint8Array };
export type MapVersion = Schemas["MapVersionShape"];
export type MapDifference = Schemas["MapDifferenceShape"];
export type MapTrouble = Schemas["MapTroubleShape"];
export type RobotMapInfo = Schemas["RobotMapShape"];
/** With its cells, as a site's map has them. */
export type RobotMap = RobotMapInfo & { cells: Uint8Array };
export type RouteAnswer = Schemas["RouteShape"];

export type Device = Schemas["DeviceShape"];
export type DeviceStatus = Device["status"];
export type MethodPace = Schemas["MethodPaceShape"];
export type Measured = Schemas["MeasuredShape"];
export type StepMeasured = Schemas["StepMeasuredShape"];
export type Activity = Schemas["Activity"];
export type DeviceProperty = Schemas["PropertyShape"];
export type DeviceMethod = Schemas["MethodShape"];
export type MethodParameter = Schemas["ParameterShape"];
export type MethodCall = Schemas["CallShape"];
export type Series = Schemas["SeriesShape"];
export type DeviceEvent = Schemas["DeviceEventShape"];
export type FieldChange = Schemas["ChangeShape"];
export type ExpectedDevice = Schemas["ExpectedDevice"];
export type Enrolment = Schemas["Door"];
export type DescriptionLook = Schemas["LookShape"];
export type DescriptionForm = NonNullable<DescriptionLook["form"]>;

export type OwnSession = Schemas["OwnSession"];
export type Factor = Schemas["FactorShape"];
export type FactorRule = Schemas["FactorRuleShape"];
export type NewFactor = Schemas["NewFactorShape"];
export type RecoveryCodes = Schemas["RecoveryCodes"];
export type SignOnProvider = Schemas["ProviderShape"];
export type SignOnAnswer = Schemas["SignOnAnswer"];
export type SignedOn = Schemas["SignedOn"];
export type SignOnList = Schemas["SignOnList"];
export type OwnSignOn = Schemas["SignOnShape"];
export type Token = Schemas["TokenShape"];
export type TokenScope = Token["scopes"][number];
export type NewToken = Schemas["NewToken"];
export type MadeToken = Schemas["MadeToken"];

export type WallScreen = Schemas["WallScreenShape"];
export type NewWallScreen = Schemas["NewWallScreen"];
export type MadeWallScreen = Schemas["MadeWallScreen"];

export type Member = Schemas["MemberShape"];
export type MemberDetail = Schemas["MemberDetail"];
export type MemberChange = Schemas["MemberChange"];
export type Invitation = Schemas["InvitationShape"];
export type InvitationList = Schemas["InvitationList"];
export type NewInvitation = Schemas["NewInvitation"];
export type MadeInvitation = Schemas["MadeInvitation"];
export type Offer = Schemas["OfferShape"];
export type NewPerson = Schemas["NewPerson"];
export type Deed = Schemas["DeedShape"];
export type AuditEntry = Schemas["AuditShape"];

export type Alert = Schemas["AlertShape"];
export type Finding = Schemas["FindingShape"];
export type Retention = Schemas["RetentionShape"];
export type SetKeeping = Schemas["SetKeeping"];
export type Operations = Schemas["OperationsShape"];
export type OverdueCommand = Schemas["OverdueShape"];
export type Queue = Schemas["QueueShape"];
export type Processes = Schemas["ProcessesShape"];
export type VipoProcess = Schemas["ProcessShape"];
export type Lease = Schemas["LeaseShape"];
export type DeadLetter = Schemas["DeadLetterShape"];
export type AlertSeverity = Alert["severity"];

export type Program = Schemas["ProgramShape"];
export type ProgramDocument = Schemas["DocumentShape"];
export type Place = Schemas["Place"];
export type Step = Schemas["StepShape"];
export type Compiled = Schemas["CompiledShape"];
export type Diagnostic = Schemas["DiagnosticShape"];
export type LibraryFunction = Schemas["LibraryShape"];
export type LibraryVersion = Schemas["LibraryVersionShape"];
export type FunctionReason = Schemas["ReasonShape"];
export type NeedOfDevice = Schemas["NeedShape"];
export type FunctionComparison = Schemas["FunctionComparisonShape"];
export type FunctionUses = Schemas["UsesShape"];
export type PromotionLook = Schemas["PromotionLookShape"];
export type PromotionBinding = Schemas["BindingShape"];
export type ProgramRelatives = Schemas["MaybeOriginShape"];

export type Run = Schemas["RunShape"];
export type RunSummary = Schemas["RunSummaryShape"];
export type RunStatus = Run["status"];
export type RunStep = Schemas["RunStepShape"];
export type StepStatus = RunStep["status"];
export type RunEvent = Schemas["RunEventShape"];
export type VersionRuns = Schemas["VersionRunsShape"];
export type RunTimeline = Schemas["TimelineShape"];
export type TimelineBar = Schemas["TimelineBar"];
export type Question = Schemas["QuestionShape"];
export type TestFault = Schemas["LineFault"];
export type AwaitedAdmission = Schemas["AwaitedAdmission"];
export type AnswerSpec = Schemas["AnswerShape"];
export type ArmedProgram = Schemas["ArmedShape"];

export type Rehearsal = Schemas["RehearsalShape"];
export type RehearsalSummary = Schemas["RehearsalSummaryShape"];
export type RehearsalStatus = Rehearsal["status"];
export type RehearsalCourse = Schemas["CourseShape"];
export type RehearsalResult = Schemas["RehearsalResultShape"];
export type RehearsalError = Schemas["RehearsalError"];
export type NearMiss = Schemas["Encounter"];
export type LogLine = Schemas["LogLine"];

export type Review = Schemas["ReviewShape"];
export type AskedReview = Schemas["AskedReviewShape"];
export type ReviewRule = Schemas["ReviewRuleShape"];

export type Version = Schemas["VersionShape"];
export type WholeVersion = Omit<Schemas["WholeVersionShape"], "document"> & { document: ProgramDocument };
/** At the path stands `new` instead of `old`; what is left out is absent there. */
export interface ValueChange {
  readonly path: readonly string[];
  readonly old?: unknown;
  readonly new?: unknown;
}
export type ConstructChange = Omit<Schemas["ConstructChangeShape"], "changes"> & {
  readonly changes: readonly ValueChange[];
};
export type ChangeKind = ConstructChange["kind"];
export interface Difference {
  readonly constructs: readonly ConstructChange[];
  readonly tidied: readonly ConstructChange[];
  readonly same: number;
}
export type ComparedSide = Omit<Schemas["SideShape"], "document" | "compiled"> & {
  readonly document: ProgramDocument | null;
  readonly compiled: Compiled | null;
};
export interface Comparison {
  readonly old: ComparedSide;
  readonly new: ComparedSide;
  readonly difference: Difference | null;
}
/** What a restore changed or would change, what stays as somebody changed it since, and what is needed. */
export interface Restored {
  readonly changes: readonly ValueChange[];
  readonly skipped: readonly ValueChange[];
  readonly needs: readonly (readonly [root: string, id: string])[];
}
export type ProgramTests = Schemas["ProgramTestsShape"];
export type ProgramTest = Schemas["ProgramTestShape"];
export type TestResult = Schemas["TestResultShape"];
export type TestRun = Schemas["TestRunShape"];
export type WholeTestRun = Schemas["WholeTestRunShape"];
export type TestOdds = Schemas["OddsShape"];
export type UnnoticedChange = Schemas["UnnoticedChange"];
export type TestText = Schemas["TestTextShape"];
export type TestCoverage = Schemas["CoverageShape"];
export type VersionTests = Schemas["VersionTestsShape"];
