/** A version is run as it was, asked about like any other run. */
import { Loader, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useDevices, useSiteMap, useVersion } from "@/api/queries";
import type { Program, Site, Version } from "@/api/types";
import { useComparison } from "@/compare/comparison";
import { LoadProblem } from "@/shell/LoadProblem";
import { RunDialog } from "@/shell/start/RunForm";

interface RunProps {
  version: Version;
  program: Program;
  site: Site;
  onClose: () => void;
}

const stored = () => Promise.resolve();

export function RunVersion({ version: { number }, program, site, onClose }: RunProps) {
  const { t } = useTranslation();
  const whole = useVersion(program.id, number, true);
  const devices = useDevices(site.slug).data ?? [];
  const places = useSiteMap(site.slug).data?.places ?? [];
  const side = String(number);
  const checked = useComparison(program.id, [side, side]).data?.new;
  if (!whole.data)
    return (
      <Modal opened onClose={onClose} title={t("start.run.title")}>
        {whole.error ? <LoadProblem error={whole.error} again={() => void whole.refetch()} /> : <Loader />}
      </Modal>
    );
  const { document } = whole.data;
  return (
    <RunDialog
      opened
      about={{ program, site, document, compiled: checked?.compiled ?? null, devices, places, version: number, stored }}
      errors={checked && !checked.problem ? checked.errors : null}
      warnings={0}
      facts={[{ tone: "plain", text: t("history.run_text", { number }) }]}
      onClose={onClose}
    />
  );
}
