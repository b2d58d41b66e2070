/** Two versions of a library function compared as a picture; for a program that may take the newer one, with its tests. */
import { Button, NativeSelect, SegmentedControl } from "@mantine/core";
import { ArrowLeft, ArrowRight } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate, useParams, useSearchParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useDevices, useProgram, useSite, useSiteMap } from "@/api/queries";
import type { ConstructChange, Device, LibraryFunction, Program, Site } from "@/api/types";
import { useSiteLive } from "@/live/site";
import { LoadProblem } from "@/shell/LoadProblem";
import { Crumb, TopBar } from "@/shell/TopBar";
import { useTitle } from "@/shell/useTitle";
import { ChangeList } from "../ChangeList";
import { Frame, MapOf, useChoice } from "../ComparedParts";
import styles from "../compare.module.css";
import type { Shown } from "../marks";
import { ScriptDifference } from "../ScriptDifference";
import { useCompareKeys } from "../useCompareKeys";
import { usePictures } from "../usePictures";
import { FunctionVerdict } from "./FunctionVerdict";
import { UpdateTests } from "./UpdateTests";
import { useFunction, useFunctionReasons, useFunctionSides } from "./functionSides";

const NO_DEVICES: Device[] = [];
const NO_CHANGES: readonly ConstructChange[] = [];

export function FunctionCompareScreen() {
  const { slug = "", id = "" } = useParams();
  const [address] = useSearchParams();
  const asked = address.get("program") ?? undefined;
  const site = useSite(slug);
  const item = useFunction(id);
  const program = useProgram(asked);
  useSiteLive(slug);
  const failed = missing(site, item, ...(asked ? [program] : []));
  if (failed)
    return (
      <Frame>
        <LoadProblem error={failed} again={() => void [site, item, program].map((query) => query.refetch())} />
      </Frame>
    );
  if (!site.data || !item.data || (asked && !program.data)) return <Frame waiting />;
  return <Loaded site={site.data} item={item.data} program={program.data} />;
}

interface LoadedProps {
  site: Site;
  item: LibraryFunction;
  /** That may take the newer version. */
  program: Program | undefined;
}

/** The versions that the address names; without them the last two. */
function useNumbers({ version }: LibraryFunction) {
  const [address, setAddress] = useSearchParams();
  const known = (name: string, otherwise: number) => {
    const number = Number(address.get(name));
    return Number.isInteger(number) && number >= 1 && number <= version ? number : otherwise;
  };
  const numbers = { old: known("old", Math.max(1, version - 1)), new: known("new", version) };
  const choose = (which: "old" | "new", number: string) =>
    setAddress((before) => ({ ...Object.fromEntries(before), [which]: number }), { replace: true });
  return { numbers, choose };
}

function Loaded({ site, item, program }: LoadedProps) {
  const { t } = useTranslation();
  const { numbers, choose } = useNumbers(item);
  const comparison = useFunctionSides(site.slug, item.id, numbers);
  const devices = useDevices(site.slug).data ?? NO_DEVICES;
  const plan = useSiteMap(site.has_map ? site.slug : undefined).data ?? null;
  const [shown, setShown] = useState<Shown>("both");
  const pictures = usePictures(site.slug, plan, devices, comparison.data, shown);
  const choice = useChoice(comparison.data?.difference?.constructs ?? NO_CHANGES);
  useCompareKeys({ walk: choice.walk, restore: () => {}, undo: () => {} });
  useTitle(`${t("compare.title")} · ${item.name}`);
  const isOne = numbers.old === numbers.new;
  const head = { item, numbers, choose, shown, setShown };
  return (
    <div className={styles.screen}>
      <Top site={site} item={item} program={program} />
      <main className={styles.body}>
        {comparison.error && !comparison.data ? (
          <div className={styles.loading}>
            <LoadProblem error={comparison.error} again={() => void comparison.refetch()} />
          </div>
        ) : (
          <>
            <Head {...head} site={site} program={program} />
            <MapOf {...{ plan, devices, pictures, choice, isOne }} comparison={comparison.data} />
            <ChangeList
              {...{ pictures, isOne }}
              comparison={comparison.data}
              chosen={choice.chosen}
              canEdit
              walk={choice.walk}
              restore={null}
              onChoose={choice.choose}
            />
            <ScriptDifference
              pictures={pictures}
              chosen={choice.change}
              onChoose={choice.choose}
              known={choice.order}
            />
          </>
        )}
      </main>
    </div>
  );
}

function Top({ site, item, program }: LoadedProps) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const back = program ? `/programs/${program.id}` : `/sites/${site.slug}/library/${item.id}`;
  const words = t(program ? "compare.back" : "compare.function.back");
  return (
    <TopBar
      site={site.slug}
      crumbs={
        <>
          <Crumb to={`/sites/${site.slug}/library`}>{site.name}</Crumb>
          <Crumb to={`/sites/${site.slug}/library/${item.id}`}>{item.name}</Crumb>
          <Crumb>{t("compare.title")}</Crumb>
        </>
      }
      actions={
        <Button
          variant="default"
          className={styles.back}
          title={words}
          leftSection={<ArrowLeft size={16} aria-hidden="true" />}
          onClick={() => void navigate(back)}
        >
          <span className={styles.words}>{words}</span>
        </Button>
      }
    />
  );
}

interface HeadProps extends LoadedProps {
  numbers: { old: number; new: number };
  choose: (which: "old" | "new", number: string) => void;
  shown: Shown;
  setShown: (shown: Shown) => void;
}

/** Which versions, what is otherwise for who calls the function, and the tests of the program that may take it. */
function Head({ site, item, program, numbers, choose, shown, setShown }: HeadProps) {
  const { t } = useTranslation();
  const reasons = useFunctionReasons(item.id, numbers).data;
  const choices = Array.from({ length: item.version }, (_, at) => String(item.version - at)).map((value) => ({
    value,
    label: t("compare.version", { number: value }),
  }));
  return (
    <section className={styles.head} aria-label={t("compare.sides")}>
      <NativeSelect
        size="xs"
        aria-label={t("compare.show.old")}
        data={choices}
        value={numbers.old}
        onChange={(event) => choose("old", event.currentTarget.value)}
      />
      <ArrowRight size={18} className={styles.arrow} aria-hidden="true" />
      <NativeSelect
        size="xs"
        aria-label={t("compare.show.new")}
        data={choices}
        value={numbers.new}
        onChange={(event) => choose("new", event.currentTarget.value)}
      />
      <FunctionVerdict reasons={reasons} />
      <span className={styles.spring} />
      <SegmentedControl
        size="xs"
        aria-label={t("compare.shown")}
        value={shown}
        onChange={(value) => setShown(value)}
        data={(["old", "both", "new"] as const).map((value) => ({ value, label: t(`compare.show.${value}`) }))}
      />
      {program ? (
        <UpdateTests
          key={`${program.id} ${numbers.new}`}
          program={program}
          role={site.role}
          update={{ library: item.id, version: numbers.new }}
        />
      ) : null}
    </section>
  );
}
