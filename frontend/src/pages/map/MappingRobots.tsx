/** Ways to the robots that can map a floor by themselves: their pages tell them to, and show the map as it grows. */
import { Button } from "@mantine/core";
import { DoorOpen, Radar } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices } from "@/api/queries";
import type { Device } from "@/api/types";

export const EXPLORE = "explore";

/** The site's robots that can map a floor; who is not approved yet waits behind the others. */
export function useMappingRobots(slug: string): Device[] {
  const able = (useDevices(slug).data ?? []).filter(
    (each) =>
      each.kind === "robot" &&
      (each.lifecycle === "approved" || each.lifecycle === "pending") &&
      each.methods.some((method) => method.name === EXPLORE),
  );
  return able.toSorted((a, b) => Number(a.lifecycle === "pending") - Number(b.lifecycle === "pending"));
}

/** A way to each of them; with `waiting`, also to letting in who waits. */
export function MappingRobots({ slug, small = false, waiting = false }: MappingRobotsProps) {
  const { t } = useTranslation();
  const robots = useMappingRobots(slug).filter((robot) => waiting || robot.lifecycle === "approved");
  return robots.map((robot) => {
    const isIn = robot.lifecycle === "approved";
    const Icon = isIn ? Radar : DoorOpen;
    const page = `/sites/${slug}/devices`;
    return (
      <Button
        key={robot.id}
        component={Link}
        to={isIn ? `${page}/${encodeURIComponent(robot.id)}#robot-map` : page}
        variant="default"
        size={small ? "xs" : "sm"}
        leftSection={<Icon size={small ? 14 : 16} aria-hidden="true" />}
      >
        {t(isIn ? "robotMap.letMap" : "robotMap.letIn", { name: robot.name })}
      </Button>
    );
  });
}

interface MappingRobotsProps {
  slug: string;
  small?: boolean;
  waiting?: boolean;
}
