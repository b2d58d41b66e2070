/** Two states of a program compared: on the map, as a list of changes, as scripts beside each other. */
import { ArrowLeft, History } from "lucide-react";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams, useSearchParams } from "react-router-dom";
import { Button } from "@mantine/core";
import { missing } from "@/api/failed";
import { useDevices, useProgram, useRelatives, useSite, useSiteMap, useVersions } from "@/api/queries";
import type { Comparison, ConstructChange, Device, Program, RunSummary, Site, Version } from "@/api/types";
import { Chip } from "@/design/Chip";
import { useTitle } from "@/shell/useTitle";
import { useSiteLive } from "@/live/site";
import type { SiteDevice } from "@/program/surroundings";
import { LoadProblem } from "@/shell/LoadProblem";
import { Crumb, TopBar } from "@/shell/TopBar";
import { ChangeList } from "./ChangeList";
import { CompareHead } from "./CompareHead";
import { useComparison, useProgramRuns } from "./comparison";
import { Frame, MapOf, useChoice } from "./ComparedParts";
import styles from "./compare.module.css";
import type { Shown } from "./marks";
import { RehearsedSides } from "./RehearsedSides";
import { ReviewBar } from "./ReviewBar";
import { RestoreDialog } from "./RestoreDialog";
import { ScriptDifference } from "./ScriptDifference";
import { DRAFT, isOneVersion, otherSide, type Relative, sidesOf, versionOfSide } from "./sides";
import { useCompareKeys } from "./useCompareKeys";
import { usePictures } from "./usePictures";
import { useRestore } from "./useRestore";

const NO_DEVICES: Device[] = [];
const NO_RUNS: RunSummary[] = [];
const NO_CHANGES: readonly ConstructChange[] = [];

export function CompareScreen() {
  const { id } = useParams();
  const program = useProgram(id);
  const site = useSite(program.data?.site);
  const versions = useVersions(id);
  useSiteLive(program.data?.site);
  const failed = missing(program, site) ?? (versions.data ? null : versions.error);
  if (failed)
    return (
      <Frame>
        {<LoadProblem error={failed} again={() => void [program, site, versions].map((q) => q.refetch())} />}
      </Frame>
    );
  if (!program.data || !site.data || !versions.data) return <Frame waiting />;
  return (
    <Loaded
      key={program.data.id}
      program={program.data}
      site={site.data}
      versions={versions.data.pages.flatMap((page) => page.items)}
    />
  );
}

type Asked = readonly [string, string] | null;

interface LoadedProps {
  program: Program;
  site: Site;
  versions: readonly Version[];
}

/** What the address asks for, and the ways to ask for something else. */
function useSides(program: Program, versions: readonly Version[]) {
  const [address, setAddress] = useSearchParams();
  const runs = useProgramRuns(program.site, program.id);
  const sides = sidesOf(address, versions[0]?.number);
  const known = runs.data ?? NO_RUNS;
  const numbers = [sides.old, sides.new].map((side) => versionOfSide(side, known));
  const waits = runs.isPending && numbers.includes(null);
  const choose = (next: { old: string; new: string }) => setAddress(next, { replace: true });
  // A run that has no version is asked for as one that is not there: the other side is shown beside that sentence.
  const asked = waits ? null : ([numbers[0] ?? "0", numbers[1] ?? "0"] as const);
  return { sides, runs: known, asked, choose };
}

function Loaded({ program, site, versions }: LoadedProps) {
  const { t } = useTranslation();
  const { sides, runs, asked, choose } = useSides(program, versions);
  const comparison = useComparison(program.id, asked);
  const devices = useDevices(site.slug).data ?? NO_DEVICES;
  useTitle(`${t("compare.title")} · ${program.name}`);
  return (
    <div className={styles.screen}>
      <CompareTop program={program} site={site} />
      <main className={styles.body}>
        {comparison.error && !comparison.data ? (
          <div className={styles.loading}>
            <LoadProblem error={comparison.error} again={() => void comparison.refetch()} />
          </div>
        ) : (
          <Compared
            {...{ program, site, versions, runs, sides, choose, devices }}
            asked={asked}
            comparison={comparison.data}
            isFormer={comparison.isPlaceholderData}
          />
        )}
      </main>
    </div>
  );
}

function CompareTop({ program, site }: { program: Program; site: Site }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  return (
    <TopBar
      site={site.slug}
      crumbs={
        <>
          <Crumb to={`/sites/${site.slug}/programs`}>{site.name}</Crumb>
          <Crumb to={`/programs/${program.id}`}>{program.name}</Crumb>
          <Crumb>{t("compare.title")}</Crumb>
        </>
      }
      chips={
        <Link to={`/sites/${site.slug}/history/${program.id}`} className={styles.chipLink}>
          <Chip tone="plain">
            <History size={14} aria-hidden="true" />
            <span className={styles.words}>{t("compare.history")}</span>
          </Chip>
        </Link>
      }
      actions={
        <Button
          variant="default"
          className={styles.back}
          title={t("compare.back")}
          leftSection={<ArrowLeft size={16} aria-hidden="true" />}
          onClick={() => void navigate(`/programs/${program.id}`)}
        >
          <span className={styles.words}>{t("compare.back")}</span>
        </Button>
      }
    />
  );
}

interface ComparedProps extends LoadedProps {
  runs: readonly RunSummary[];
  sides: { old: string; new: string };
  asked: Asked;
  choose: (next: { old: string; new: string }) => void;
  devices: readonly SiteDevice[];
  comparison: Comparison | undefined;
  /** It is that of the sides before, until that of these has come. */
  isFormer: boolean;
}

const isNumber = (side: string) => /^\d+$/.test(side);

/** The sides, if both are of this program: others cannot be approved or rehearsed here. */
function ownSides(asked: Asked): Asked {
  return asked?.some((side) => otherSide(side)) ? null : asked;
}

function useKnownRelatives(program: string): readonly Relative[] {
  const found = useRelatives(program).data;
  return useMemo(() => (found ? [...(found.origin ? [found.origin] : []), ...found.copies] : []), [found]);
}

/** Restoring goes from a version on the old side into what is drawn now; null where there is no such way. */
function useOffer({ program, site, sides, asked, choose, comparison, isFormer }: ComparedProps) {
  const isKnown = !isFormer && comparison?.old.problem === "";
  const from = asked && isNumber(asked[0]) && isKnown ? Number(asked[0]) : null;
  const toDraft = () => choose({ old: sides.old, new: DRAFT });
  const restore = useRestore(program.id, from, sides.new !== DRAFT, toDraft);
  const canEdit = site.role === "author" || site.role === "admin";
  return { from, restore, canEdit, offered: canEdit && from !== null ? restore : null };
}

function Compared(props: ComparedProps) {
  const { site, versions, runs, sides, choose, devices, comparison } = props;
  const plan = useSiteMap(site.has_map ? site.slug : undefined).data ?? null;
  const relatives = useKnownRelatives(props.program.id);
  const [shown, setShown] = useState<Shown>("both");
  const pictures = usePictures(site.slug, plan, devices, comparison, shown);
  const choice = useChoice(comparison?.difference?.constructs ?? NO_CHANGES);
  const { order, chosen, change } = choice;
  const { from, restore, offered, canEdit } = useOffer(props);
  useCompareKeys({
    walk: choice.walk,
    restore: () => change && offered?.ask({ what: "construct", change }),
    undo: restore.undo,
  });
  const rest = order.length > 0 ? offered : null;
  const isOne = props.asked !== null && isOneVersion(props.asked);
  return (
    <>
      <CompareHead {...{ versions, runs, relatives, sides, choose, shown, setShown, comparison }} restore={rest}>
        <ReviewBar
          program={props.program.id}
          role={site.role}
          asked={ownSides(props.asked)}
          onSince={(old) => choose({ ...sides, old })}
        />
        {props.asked && ownSides(props.asked) ? (
          <RehearsedSides
            key={props.asked.join()}
            program={props.program.id}
            role={site.role}
            asked={props.asked}
            nameOf={(id) => devices.find((device) => device.id === id)?.name ?? id}
          />
        ) : null}
      </CompareHead>
      <MapOf {...{ plan, devices, comparison, pictures, choice, isOne }} />
      <ChangeList
        {...{ comparison, pictures, chosen, canEdit, isOne }}
        walk={choice.walk}
        restore={offered}
        onChoose={choice.choose}
      />
      <ScriptDifference pictures={pictures} chosen={change} onChoose={choice.choose} known={order} />
      <RestoreDialog restore={restore} version={from} pictures={pictures} />
    </>
  );
}
